// Periodic cells with smooth borders: plates of bark, and how far from their cracks a place is.
#pragma once

#include "math/vec.h"

namespace relief::samples {

struct PlateField {
    int columns = 1, rows = 1; ///< cells of a tile
    float jitter = 0.8f;       ///< of the cell points, [0, 1]
    float rounding = 0.1f;     ///< width over which the borders of a corner melt together, tile units
    uint32_t seed = 0;
};

struct PlateHit {
    float distance = 0; ///< to the nearest border, tile units, >= 0
    Vec2f inward;       ///< away from the border, length <= 1 (shorter where borders compete)
    uint32_t seed = 0;  ///< of the plate
};

/// The plate that a place of the tile [0, 1]^2 belongs to; periodic. Cells after Worley 1996, A Cellular
/// Texture Basis Function; distances to the bisectors, blended by weights that fall exponentially.
PlateHit find_plate(const PlateField& field, const Vec2f& uv);

} // namespace relief::samples
