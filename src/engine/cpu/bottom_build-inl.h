// From the vertices of a tile to its bottom tree: blocks first, then boxes upward.
#if defined(RELIEF_BOTTOM_BUILD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_BOTTOM_BUILD_INL_H
#undef RELIEF_BOTTOM_BUILD_INL_H
#else
#define RELIEF_BOTTOM_BUILD_INL_H
#endif

#include <cstring>

#include "engine/cpu/patch_evaluation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

template <size_t W> HWY_INLINE float reduce_min(const Lanes<W>& a) {
    auto least = a.part[0];
    for (size_t p = 1; p < Lanes<W>::kParts; ++p) least = hn::Min(least, a.part[p]);
    return hn::GetLane(hn::MinOfLanes(typename Lanes<W>::D(), least));
}

template <size_t W> HWY_INLINE float reduce_max(const Lanes<W>& a) {
    auto greatest = a.part[0];
    for (size_t p = 1; p < Lanes<W>::kParts; ++p) greatest = hn::Max(greatest, a.part[p]);
    return hn::GetLane(hn::MaxOfLanes(typename Lanes<W>::D(), greatest));
}

/// Copies the 5 x 3 vertices of a block; a tile smaller than the block repeats its last column and row, which
/// makes triangles without area that no ray hits.
HWY_INLINE void fill_block(const VertexGrid& grid, uint32_t column, uint32_t row, uint32_t cell_count,
                           cpu::Block& block) {
    for (int axis = 0; axis < 3; ++axis) {
        float* const target = block.vertex[axis];
        for (uint32_t r = 0; r < 3; ++r) {
            const float* const source = grid.axis[axis] + HWY_MIN(row + r, cell_count) * VertexGrid::kPitch;
            if (column + 4 <= cell_count) {
                std::memcpy(target + r * 5, source + column, 5 * sizeof(float));
                continue;
            }
            for (uint32_t c = 0; c < 5; ++c) target[r * 5 + c] = source[HWY_MIN(column + c, cell_count)];
        }
        target[15] = target[14];
    }
}

/// Boxes of eight blocks.
HWY_INLINE void store_block_boxes(const cpu::Block* blocks, cpu::Node8& node) {
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t k = 0; k < 8; ++k) {
            // To four lanes at once, the rest by lanes: two short chains instead of a shuffle for every
            // halving.
            const float* const v = blocks[k].vertex[axis];
            const Lanes4 a = Lanes4::load(v), b = Lanes4::load(v + 4), c = Lanes4::load(v + 8),
                         d = Lanes4::load(v + 12);
            node.bounds[axis][k] = reduce_min(min(min(a, b), min(c, d)));
            node.bounds[3 + axis][k] = reduce_max(max(max(a, b), max(c, d)));
        }
}

HWY_INLINE void build_boxes(cpu::BottomTree& tree) {
    const cpu::Block* blocks = tree.blocks();
    if (tree.level == 5) {
        for (uint32_t g = 0; g < 16; ++g) {
            cpu::Node8& node = tree.group(int(g));
            store_block_boxes(blocks + g * 8, node);
            for (int axis = 0; axis < 3; ++axis) {
                tree.root().bounds[axis][g] = reduce_min(Lanes8::load(node.bounds[axis]));
                tree.root().bounds[3 + axis][g] = reduce_max(Lanes8::load(node.bounds[3 + axis]));
            }
        }
    } else if (tree.level == 4) {
        for (uint32_t g = 0; g < 16; ++g)
            for (int axis = 0; axis < 3; ++axis) {
                const Lanes16 a = Lanes16::load(blocks[2 * g].vertex[axis]);
                const Lanes16 b = Lanes16::load(blocks[2 * g + 1].vertex[axis]);
                tree.root().bounds[axis][g] = reduce_min(min(a, b));
                tree.root().bounds[3 + axis][g] = reduce_max(max(a, b));
            }
    } else if (tree.level == 3) {
        store_block_boxes(blocks, tree.group(0));
    }
}

void build_tree(const Surface& surface, const PatchLevels& levels, cpu::BottomTree& tree) {
    VertexGrid grid;
    const uint32_t cell_count = 1u << tree.level;
    evaluate_tile(surface, {tree.key.patch, levels, tree.cell_x, tree.cell_y, cell_count}, grid);
    for (uint32_t b = 0; b < cpu::BottomTree::block_count(int(tree.level)); ++b) {
        uint32_t column = 0, row = 0;
        cpu::BottomTree::block_cell(int(tree.level), b, column, row);
        fill_block(grid, column, row, cell_count, tree.blocks()[b]);
    }
    build_boxes(tree);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
