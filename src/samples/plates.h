// Periodic cells with smooth borders: plates of bark, and how far from their cracks a place is.
#pragma once

#include <vector>

#include "math/vec.h"

namespace relief::samples {

struct PlateHit {
    float distance = 0; ///< to the nearest border, tile units, >= 0
    Vec2f inward;       ///< away from the border, length <= 1 (shorter where borders compete)
    uint32_t seed = 0;  ///< of the plate
};

/// Plates over the tile [0, 1]^2, repeated in both directions. Cells after Worley 1996, A Cellular Texture
/// Basis Function; distances to the bisectors, blended by weights that fall exponentially.
class PlateField {
  public:
    struct Config {
        int columns = 4, rows = 4; ///< cells of a tile, at least 4 each; columns even
        float jitter = 0.8f;       ///< of the cell points, [0, 1]
        float rounding = 0.1f;     ///< width over which the borders of a corner melt together, tile units
        uint32_t seed = 0;
    };

    explicit PlateField(const Config& config);
    PlateHit find(const Vec2f& uv) const;

  private:
    struct Cell {
        Vec2f offset; ///< of its point from its lattice corner
        uint32_t seed = 0;
    };
    const Cell& cell(int x, int y) const;

    Config config_;
    std::vector<Cell> cells_;
};

} // namespace relief::samples
