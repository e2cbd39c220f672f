// Places of the texels of a map on the displaced surface of an object.
#pragma once

#include <cstddef>
#include <map>
#include <optional>

#include "relief/scene.h"
#include "viewer/place_grid.h"
#include "viewer/texel_frames.h"

namespace relief::viewer {

class TexelPlaces {
  public:
    /// The surface of an object without its displacement, coarsely sampled, and the frames of its map. Throws
    /// as make_displaced_mesh and convert_map.
    TexelPlaces(const Scene& scene, uint32_t object);

    /// World-space position of the middle of a texel by the map as it is now; nothing where no face has it.
    /// `map` is the displacement of the object. Draws grids when they are needed: one thread at a time.
    std::optional<Vec3f> find(const Displacement& map, const MapTile& tile, int x, int y) const;

    /// Tiles that have taken memory so far.
    size_t drawn_tiles() const { return grids_.size(); }

  private:
    /// Draws it when it is asked for first, so that tiles that no dab reaches take no memory.
    const PlaceGrid& find_grid(const Displacement& map, const MapTile& tile) const;
    /// Turns what the map means at a place of a tile into the space of the object.
    Vec3f turn(const Displacement& map, const Vec3f& displacement, int udim, float column, float row) const;

    Affine world_from_object_;
    Mesh base_;                              ///< the surface without displacement, in the space of the object
    mutable std::map<int, PlaceGrid> grids_; ///< by the number of the tile
    std::optional<TexelFrames> frames_;      ///< of maps in tangent space
};

} // namespace relief::viewer
