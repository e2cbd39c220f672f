// The texels that one dab of a brush changes: those whose surface lies near the cursor.
#pragma once

#include <vector>

#include "viewer/brush.h"
#include "viewer/surface_point.h"
#include "viewer/texel_places.h"

namespace relief::viewer {

/// A part of a dab, within one block of texels of one tile.
struct DabPiece {
    int udim = 1001;
    TexelBox box;               ///< inside the tile
    std::vector<float> weights; ///< per texel of the box, row by row, [0, 1]

    float weight(int x, int y) const {
        return weights[size_t(y - box.y0) * size_t(box.x1 - box.x0) + size_t(x - box.x0)];
    }
};

/// Weights fall off with the distance in space between the surface of a texel and `centre`: from 1 there to 0
/// at `radius` pixels of the whole picture, at the distance of the centre from the camera. The dab begins
/// with all that the picture shows there of the object, across seams of uvs, and goes on into what bumps
/// hide, ever weaker away from what is seen. `places`: of the object.
std::vector<DabPiece> find_dab(const Scene& scene, const ShownPicture& picture, const SurfacePoint& centre,
                               float radius, const TexelPlaces& places);

} // namespace relief::viewer
