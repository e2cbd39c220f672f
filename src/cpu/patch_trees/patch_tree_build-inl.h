// From the vertices of a tile to its patch tree: the grid without padding, then boxes upward.
#pragma once

#include <cstring>

#include "base/check.h"
#include "cpu/patch_trees/patch_evaluation-inl.h"
#include "formulas/levels.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// The grid without its padding; see PatchTree::column_count.
RELIEF_INLINE void fill_vertices(const VertexGrid& grid, cpu::PatchTree& tree) {
    const int level = int(tree.level);
    const uint32_t cells = 1u << level, columns = cpu::PatchTree::column_count(level),
                   rows = cpu::PatchTree::row_count(level);
    for (int axis = 0; axis < 3; ++axis) {
        float* target = tree.vertices(axis);
        for (uint32_t r = 0; r < rows; ++r, target += columns) {
            const float* const source = grid.axis[axis] + HWY_MIN(r, cells) * VertexGrid::kPitch;
            std::memcpy(target, source, (cells + 1) * sizeof(float));
            for (uint32_t c = cells + 1; c < columns; ++c) target[c] = source[cells];
        }
    }
    tree.vertices(3)[0] = 0;
}

/// Box of five columns of vertices, into one slot of a node.
template <size_t W>
RELIEF_INLINE void store_box(const cpu::PatchTree& tree, uint32_t first, uint32_t rows, float (&bounds)[6][W],
                             uint32_t slot) {
    const uint32_t columns = cpu::PatchTree::column_count(int(tree.level));
    for (int axis = 0; axis < 3; ++axis) {
        const float* v = tree.vertices(axis) + first;
        // To four lanes at once, the rest by lanes: short chains instead of a shuffle for every halving.
        Lanes4 least = Lanes4::load_unaligned(v), greatest = least;
        for (uint32_t r = 0; r < rows; ++r, v += columns) {
            const Lanes4 a = Lanes4::load_unaligned(v), b = Lanes4::load_unaligned(v + 1);
            least = min(least, min(a, b)), greatest = max(greatest, max(a, b));
        }
        bounds[axis][slot] = reduce_min(least), bounds[3 + axis][slot] = reduce_max(greatest);
    }
}

/// What holds all of `boxes`, into one slot of the node above.
template <size_t W>
RELIEF_INLINE void store_union(const float (&boxes)[6][W], cpu::Node16& above, uint32_t slot) {
    for (int axis = 0; axis < 3; ++axis) {
        above.bounds[axis][slot] = reduce_min(Lanes<W>::load(boxes[axis]));
        above.bounds[3 + axis][slot] = reduce_max(Lanes<W>::load(boxes[3 + axis]));
    }
}

template <int kLevel> RELIEF_INLINE void build_nodes(cpu::PatchTree& tree) {
    using Shape = cpu::TreeShape<kLevel>;
    for (uint32_t g = 0; g < (Shape::kHasGroups ? 16 : 1); ++g) {
        auto& node = tree.node<kLevel>(g);
        for (uint32_t k = 0; k < Shape::kWidth; ++k) {
            const uint32_t block = (g * Shape::kWidth + k) * Shape::kLeafBlocks;
            store_box(tree, cpu::PatchTree::find_first_vertex(kLevel, block), 2 * Shape::kLeafBlocks + 1,
                      node.bounds, k);
        }
        if constexpr (Shape::kHasGroups) store_union(node.bounds, tree.root(), g);
    }
}

RELIEF_INLINE void build_boxes(cpu::PatchTree& tree) {
    if (tree.level == 6) build_nodes<6>(tree);
    if (tree.level == 5) build_nodes<5>(tree);
    if (tree.level == 4) build_nodes<4>(tree);
    if (tree.level == 3) build_nodes<3>(tree);
}

/// Extends `box` by (cells + 1)^2 vertices.
RELIEF_INLINE void extend_by_grid(Box& box, const VertexGrid& grid, uint32_t cells) {
    for (int axis = 0; axis < 3; ++axis) {
        Lanes4 least(get_component(box.lower, axis)), greatest(get_component(box.upper, axis));
        const auto extend = [&](const Lanes4& v) { least = min(least, v), greatest = max(greatest, v); };
        for (uint32_t r = 0; r <= cells; ++r) {
            const float* const row = grid.axis[axis] + r * VertexGrid::kPitch;
            if (cells < 4) {
                for (uint32_t c = 0; c <= cells; ++c) extend(Lanes4(row[c]));
                continue;
            }
            for (uint32_t c = 0; c < cells; c += 4) extend(Lanes4::load_unaligned(row + c));
            extend(Lanes4::load_unaligned(row + cells - 3));
        }
        set_component(box.lower, axis, reduce_min(least));
        set_component(box.upper, axis, reduce_max(greatest));
    }
}

/// Box of all vertices of a patch at a level up to kTileLevel; lower levels use a subset of them.
Box find_box(const Surface& surface, uint32_t patch, uint32_t level) {
    DCHECK(level <= uint32_t(cpu::kTileLevel));
    const uint32_t cells = 1u << level;
    VertexGrid grid;
    evaluate_tile(surface, {patch, unpack_levels(scalar::pack_uniform_level(level)), 0, 0, cells}, grid);
    Box box;
    extend_by_grid(box, grid, cells);
    return box;
}

void build_tree(const Surface& surface, const PatchLevels& levels, cpu::PatchTree& tree) {
    VertexGrid grid;
    evaluate_tile(surface, {tree.key.patch, levels, tree.cell_x, tree.cell_y, 1u << tree.level}, grid);
    fill_vertices(grid, tree);
    build_boxes(tree);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
