// Where the displaced surface of an object is, texel by texel.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "relief/scene.h"
#include "viewer/texel_frames.h"

namespace relief::viewer {

class TexelPlaces {
  public:
    /// The surface of an object without its displacement, coarsely sampled, and the frames of its map. Throws
    /// as make_displaced_mesh and convert_map.
    TexelPlaces(const Scene& scene, uint32_t object);

    /// World-space position of the middle of a texel by the map as it is now; nothing where no face has it.
    /// `map` is the displacement of the object.
    std::optional<Vec3f> find(const Displacement& map, const MapTile& tile, int x, int y) const;

  private:
    /// Positions of the surface without displacement, by rows of the map; NaN where there is none.
    struct Grid {
        int width = 0, height = 0;
        std::vector<Vec3f> positions;
    };

    void draw_base(const Mesh& base, const Displacement& map);
    void draw_triangle(const Vec3f (&p)[3], const Vec2f (&uv)[3], const Displacement& map);
    std::optional<Vec3f> find_base(const Grid& grid, float column, float row) const;
    /// Of the world, from what the map means at a place of a tile.
    Vec3f turn(const Displacement& map, const Vec3f& displacement, int udim, float column, float row) const;

    Affine world_from_object_;
    std::map<int, Grid> grids_;         ///< by the number of the tile
    std::optional<TexelFrames> frames_; ///< of maps in tangent space
};

} // namespace relief::viewer
