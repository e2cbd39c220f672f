// Binary trees in heap order: children of key n have keys 2n and 2n + 1 (formulas/tree.h).
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/tree_links.h"
#include "formulas/tree.h"

namespace relief {

/// Slot k is the node of key k; slot 0 is empty, as are all that the tree does not use (word kEmptySlot).
struct DenseHeap {
    static constexpr int kMaxLevels = 26; ///< 2 GiB

    std::vector<TreeNode> nodes; ///< 2^levels slots, none: no primitives
    std::vector<uint32_t> primitive_ids;
    int levels = 0; ///< of the deepest node, counting from 1

    size_t byte_count() const {
        return nodes.size() * sizeof(TreeNode) + primitive_ids.size() * sizeof(uint32_t);
    }
};

/// Only the slots in use, and a directory from keys to slots: about 67 bytes for two siblings.
struct SuccinctHeap {
    std::vector<TreeNode>
        nodes; ///< slot 0 is empty, the root slot 1, siblings at 2k and 2k + 1; none: no primitives
    std::vector<scalar::HeapBlock> blocks;
    std::vector<scalar::HeapBrick> bricks;
    scalar::HeapForm form{};
    std::vector<uint32_t> primitive_ids;
    int depth = 0; ///< edges on the longest way down

    size_t directory_bytes() const {
        return blocks.size() * sizeof(scalar::HeapBlock) + bricks.size() * sizeof(scalar::HeapBrick);
    }
    size_t byte_count() const {
        return nodes.size() * sizeof(TreeNode) + directory_bytes() + primitive_ids.size() * sizeof(uint32_t);
    }
};

/// Throws Error for trees deeper than scalar::kTrailLevels64; limit_depth helps.
SuccinctHeap make_succinct_heap(const AxisBvh& tree);

/// Whether there is a node of that key. Of a succinct heap the directory alone is read.
bool contains_key(const DenseHeap& heap, uint64_t key);
bool contains_key(const SuccinctHeap& heap, uint64_t key);

/// Number of slots in use.
size_t count_used_slots(const DenseHeap& heap);

/// Edges on the longest way down; a heap may have more levels than its tree.
int compute_depth(const DenseHeap& heap);

} // namespace relief
