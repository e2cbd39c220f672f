// Complete quadtree over the cells of a patch or tile, without links (cf. Harada 2015): by levels, in Morton
// order; a node is three words, one per axis: lower code, upper code. Vertices follow by rows.
#ifndef RELIEF_PATCH_TREE_H
#define RELIEF_PATCH_TREE_H
#include "formulas/exact.h"
#include "formulas/levels.h"

#include "formulas/begin.h"

const uint kTreeLevels = 5u;       ///< maximum for a tile
const uint kTreeHeaderWords = 16u; ///< origin, scale, level, reversed edges, padding
const uint kTreeNodeWords = 3u;
const uint kPoolUnitWords = 16u; ///< alignment of trees
const uint kCellBits = 25u;      ///< width of make_cell_rank

// Words of a tree's header.
const uint kTreeOrigin = 0u;
const uint kTreeScale = 3u;
const uint kTreeLevel = 6u;
const uint kTreeReversed = 7u; ///< one bit per edge: its line runs against the patch's winding

/// Number of nodes above `level`.
FN uint count_nodes_above(const uint level) { return ((1u << (2u * level)) - 1u) / 3u; }

FN uint first_vertex_word(const uint level) {
    return kTreeHeaderWords + kTreeNodeWords * count_nodes_above(level + 1u);
}

FN uint count_tree_units(const uint level) {
    uint side = (1u << level) + 1u;
    return (first_vertex_word(level) + 3u * side * side + kPoolUnitWords - 1u) / kPoolUnitWords;
}

/// Column of a Morton index of at most ten bits: every second bit from the lowest.
FN uint morton_column(const uint m) {
    uint x = m & 0x155u;
    x = (x | (x >> 1u)) & 0x133u;
    x = (x | (x >> 2u)) & 0x10fu;
    return (x | (x >> 4u)) & 0x01fu;
}
FN uint morton_row(const uint m) { return morton_column(m >> 1u); }

/// XOR masks that reverse the traversal of a level in column or row direction, for 2^bits columns and rows.
FN uint make_order_mask(const bool is_u_backward, const bool is_v_backward) {
    return (is_u_backward ? 0x155u : 0u) | (is_v_backward ? 0x2aau : 0u);
}

// Requirements of all rays, ORed: bits 0..5 levels, then five bits an edge, one per level it is coarser.
FN uint make_need(const uint level, const uint field_levels) {
    uint own = packed_patch_level(field_levels);
    uint need = 1u << level;
    for (uint edge = 0u; edge < 4u; ++edge) {
        uint shift = min_uint(own - packed_edge_level(field_levels, edge), kTreeLevels);
        if (shift > 0u) need |= 1u << (5u + 5u * edge + shift);
    }
    return need;
}

FN uint need_moves(const uint need, const uint edge) { return (need >> (5u + 5u * edge)) & 0x3eu; }

#include "formulas/end.h"
#endif
