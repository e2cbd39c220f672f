// Any binary tree as a heap with empty slots, for tests: the library makes such heaps of linear trees alone.
#pragma once

#include <bit>
#include <span>
#include <vector>

#include "formulas/tree.h"
#include "lab/trees/heap_tree.h"

namespace relief::test {

/// The tree has less than DenseHeap::kMaxLevels levels below its root.
inline DenseHeap make_dense_heap(const Bvh& bvh, std::span<const uint8_t> axes) {
    DenseHeap heap;
    if (bvh.nodes.empty()) return heap;
    heap.levels = compute_depth(bvh) + 1;
    heap.primitive_ids = bvh.primitive_ids;
    TreeNode none{};
    none.word = scalar::kEmptySlot;
    heap.nodes.assign(size_t(1) << heap.levels, none);
    struct KeyedNode {
        uint64_t key;
        uint32_t node;
    };
    std::vector<KeyedNode> pending{{1, 0}};
    while (!pending.empty()) {
        const KeyedNode place = pending.back();
        pending.pop_back();
        const BvhNode& node = bvh.nodes[place.node];
        TreeNode& slot = heap.nodes[place.key];
        slot = std::bit_cast<TreeNode>(node);
        if (node.is_leaf()) continue;
        slot.first = 0, slot.word = scalar::make_inner_word(axes[place.node]);
        pending.push_back({2 * place.key, node.first});
        pending.push_back({2 * place.key + 1, node.first + 1});
    }
    return heap;
}

} // namespace relief::test
