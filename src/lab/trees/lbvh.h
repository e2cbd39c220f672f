// Linear BVH: the tree that the bits of sorted Morton codes spell (Karras 2012; Apetrei 2014, for nodes
// numbered by their cut; Murguia et al. 2013 for the heap).
//
// The rule, so that every builder makes the same tree, node for node, however it works:
// - Primitives are sorted by code; equal codes keep the order of their indices. Entry g of primitive_ids is
//   the g-th of them.
// - A node stands for the entries [a, b]. Where the codes of a and b differ, p is the highest bit in which
//   they do, and the right child starts at the first entry with bit p set. The axis is that of bit p.
// - Where they are equal and the entries are more than max_leaf_size, the same goes for the bits of the
//   entries' numbers g. The axis is 0. Otherwise the node is a leaf, and its `first` is a.
// - Every entry g > 0 at which some node's right child starts has a number c among those in ascending order:
//   the children of that node are nodes 1 + 2c and 2 + 2c. The root is node 0.
// - Boxes are unions, upwards from the leaves; zeros may differ in their sign.
#pragma once

#include <cstdint>
#include <span>

#include "lab/trees/heap_tree.h"

namespace relief {

class LbvhBuilder {
  public:
    struct Config {
        int code_bits = 30;         ///< 30 or 63
        uint32_t max_leaf_size = 4; ///< primitives of equal codes, [1, kNodeCountMask]
    };

    /// At most code_bits + 30 levels below the root. Every box must be finite and not empty. The same for any
    /// number of threads. No boxes: an empty tree. Throws Error for more than 2^30 primitives.
    static AxisBvh build(std::span<const Box> boxes, const Config& config);

    struct HeapConfig {
        int code_bits = 30; ///< 30 or 63
        int levels = 0; ///< [1, DenseHeap::kMaxLevels]: the heap has 2^levels slots; 0: choose_heap_levels
    };

    /// The paper's heap of 2^levels slots; last-level leaves hold the rest. Error for over kNodeCountMask.
    static DenseHeap build_heap(std::span<const Box> boxes, const HeapConfig& config);
};

/// About four slots a primitive, as in the paper's examples.
int choose_heap_levels(size_t primitive_count);

} // namespace relief
