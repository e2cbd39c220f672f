// Levels of a patch and of its edges, and how boundary samples move to match coarser edges.
#ifndef RELIEF_LEVELS_H
#define RELIEF_LEVELS_H
#include "formulas/begin.h"

/// Level of a patch or edge for rays with this LOD bias.
FN uint lower_level(const uint level, const uint lod_bias) {
    return level > lod_bias ? level - lod_bias : 0u;
}

/// Packed levels: 5 x 4 bits, the patch's own, then those of its edges.
FN uint packed_patch_level(const uint packed) { return packed & 15u; }
FN uint packed_edge_level(const uint packed, const uint edge) { return (packed >> (4u + 4u * edge)) & 15u; }

FN uint lower_packed_levels(const uint packed, const uint lod_bias) {
    uint result = 0u;
    for (uint k = 0u; k < 20u; k += 4u) result |= lower_level((packed >> k) & 15u, lod_bias) << k;
    return result;
}

/// 5 x 3 bits, of levels up to kMaxNarrowLevel, and back.
const uint kMaxNarrowLevel = 7u;
FN uint narrow_levels(const uint packed) {
    uint result = 0u;
    for (uint k = 0u; k < 5u; ++k) result |= ((packed >> (4u * k)) & 7u) << (3u * k);
    return result;
}
FN uint widen_levels(const uint narrow) {
    uint result = 0u;
    for (uint k = 0u; k < 5u; ++k) result |= ((narrow >> (3u * k)) & 7u) << (4u * k);
    return result;
}

/// The same level for a patch and its edges.
FN uint pack_uniform_level(const uint level) { return level * 0x11111u; }

/// Index of an edge sample, snapped to the nearest of the edge's level, `shift` below (ties: later).
FN uint move_line_sample(const uint k, const uint shift) {
    return (k + ((1u << shift) >> 1u)) >> shift << shift;
}

/// Edge, 0 to 3, that sample (i, j) of 2^level cells per side lies on; 4 for interior samples and corners.
FN uint find_sample_edge(const uint i, const uint j, const uint level) {
    uint n = 1u << level;
    bool is_on_u_edge = j == 0u || j == n;
    bool is_on_v_edge = i == 0u || i == n;
    if (is_on_u_edge == is_on_v_edge) return 4u;
    return j == 0u ? 0u : i == n ? 1u : j == n ? 2u : 3u;
}

/// Index of sample (i, j) along edge `edge`, from the start of its line.
FN uint find_line_sample(const uint i, const uint j, const uint level, const uint edge,
                         const bool is_reversed) {
    uint n = 1u << level;
    uint k = edge == 0u ? i : edge == 1u ? j : edge == 2u ? n - i : n - j;
    return is_reversed ? n - k : k;
}

struct GridSample {
    uint i, j;
};

/// Position that sample (i, j) of edge `edge` is snapped to when the edge is `shift` levels coarser than the
/// patch; `reversed` has a bit for each edge whose line runs against the patch's winding.
FN GridSample move_boundary_sample(const uint i, const uint j, const uint level, const uint edge,
                                   const uint shift, const uint reversed) {
    uint n = 1u << level;
    bool is_reversed = ((reversed >> edge) & 1u) != 0u;
    uint k = move_line_sample(find_line_sample(i, j, level, edge, is_reversed), shift);
    if (is_reversed) k = n - k;
    GridSample result = {i, j};
    if (edge == 0u) result.i = k;
    if (edge == 1u) result.j = k;
    if (edge == 2u) result.i = n - k;
    if (edge == 3u) result.j = n - k;
    return result;
}

#include "formulas/end.h"
#endif
