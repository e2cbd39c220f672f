// How directions of an object's space lie in the tangent frames of a map, anywhere on the map.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"

namespace relief::viewer {

class TexelFrames {
  public:
    /// Frames of a map in tangent space on its mesh, coarsely sampled. Throws as convert_map.
    TexelFrames(const Displacement& map, const Mesh& mesh);

    /// The components of `direction` along t, b and n at a place of a tile, both of [0, 1], rows from the
    /// top.
    Vec3f express(const Vec3f& direction, int udim, float column, float row) const;

    /// Texels of one tile's frames, per side.
    uint32_t side() const { return axes_.front().tiles.front().texture->width; }

  private:
    /// For x, y and z of the object a map of what they are in each frame.
    std::vector<Displacement> axes_;
};

} // namespace relief::viewer
