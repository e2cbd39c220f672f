// How much a displacement changes where a uv is a little off, for choosing how finely uvs are interpolated.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "math/vec.h"
#include "surface/map/texel_range.h"
#include "surface/patch/surface.h"

namespace relief {

/// Image of a map that a patch reads first, and the offset of that image's tile.
struct TileChoice {
    TileIndex index = 0;
    Vec2f offset{};
};

/// Chooses the tile of a map with UDIM tiles: that of the middle of the uvs or, of a face across several, the
/// one with most texels. Surface::kNoTile where the map has none there.
TileChoice choose_tile(const DisplacementMap& map, const std::array<Vec2f, 4>& uvs);

/// Bounds on the displacement of quads by their uvs, in scene units (for tangent space: with frames of unit
/// length). Finds steps between texels by blocks when they are first asked for. Thread safe; refers to the
/// map.
class DisplacementChange {
  public:
    DisplacementChange(const DisplacementMap& map, bool is_udim);

    /// Largest change of the displacement anywhere within a quad, if the uvs there are off by at most `error`
    /// (both coordinates not negative). A larger bound is returned where that is no more than `enough`, which
    /// takes less time.
    double find_change(const std::array<Vec2f, 4>& uvs, const Vec2<double>& error, double enough = 0) const;

    /// The largest length that a texel of the map may displace by.
    double longest() const { return longest_; }
    bool is_tangent() const { return map_.is_tangent; }
    /// Whether it displaces along tangents, which heights do not.
    bool uses_tangents() const {
        return map_.is_tangent && !(map_.matrix[0] == Vec3f{} && map_.matrix[1] == Vec3f{});
    }

  private:
    struct Blocks {
        uint32_t width = 0, height = 0;
        std::vector<std::atomic<float>> steps; ///< largest step to a neighbour; negative: not known yet
    };
    float find_step(size_t tile, uint32_t x, uint32_t y) const;
    double find_step_across_tiles(TileIndex tile, const std::array<int64_t, 2>& columns,
                                  const std::array<int64_t, 2>& rows) const;
    float find_step_by_blocks(size_t tile, const TexelRectangle& texels) const;

    const DisplacementMap& map_;
    bool is_udim_;
    double longest_;
    mutable std::vector<Blocks> blocks_; ///< one per tile
};

} // namespace relief
