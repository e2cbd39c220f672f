// The faces of a subdivision mesh, as they are and while they are cut into quads.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec.h"
#include "math/vec_double.h"
#include "surface/mesh/quad_place.h"

namespace relief {

/// Faces with any number of corners. Corner k of face f is entry starts[f] + k of `points`, `edges` and each
/// set of `uvs`; its edge goes to the next corner.
struct Cage {
    uint32_t point_count = 0;
    std::vector<uint32_t> starts; ///< one per face, and the end of the last one
    std::vector<uint32_t> points, edges;
    std::vector<QuadPlace> places;       ///< per face; only those of quads have a meaning
    std::vector<uint8_t> is_accurate;    ///< per face: need not be cut any more
    std::vector<uint32_t> fits;          ///< per face: number of its fitted patch, or kNoIndex
    bool has_uvs = false;                ///< the first set of `uvs` is that of the mesh
    std::vector<std::vector<Vec2f>> uvs; ///< per set: limit uvs of the corners
    std::vector<bool> is_sharp;          ///< per edge: a boundary, or a crease that stays
    std::vector<float> semi_sharpness;   ///< per edge: sharpness of a crease that wears off, or 0
    std::vector<uint32_t> side_fits;     ///< per edge: number of its fitted curve, or kNoIndex
    std::vector<bool> is_regular;        ///< per point: the limit is smooth with finite derivatives around it
    std::vector<bool> is_straight;       ///< per point: regular except for a semi-sharp crease through it
    std::vector<Vec3d> limit_normals;    ///< per point: where it is irregular and smooth, else (0, 0, 0)

    uint32_t face_count() const { return uint32_t(starts.size()) - 1; }
    uint32_t face_size(uint32_t face) const { return starts[face + 1] - starts[face]; }
};

} // namespace relief
