// What walks without a stack need of a tree besides its nodes: axes of inner nodes, parents, skip links.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/bvh.h"
#include "formulas/tree.h"

namespace relief {

using scalar::TreeNode;
static_assert(sizeof(TreeNode) == sizeof(BvhNode));

/// A Bvh with its links. Nodes keep their numbers.
struct LinkedBvh {
    std::vector<TreeNode> nodes; ///< node 0 is the root; no nodes: no primitives
    std::vector<uint32_t> primitive_ids;
    std::vector<uint32_t> parents; ///< kNoNode for the root
    std::vector<uint32_t> skips;   ///< the node after the subtree, left before right; kNoNode behind the last
    int depth = 0;                 ///< edges on the longest way down

    /// Of the nodes and ids; links on top: 4 bytes a node for each kind.
    size_t byte_count() const {
        return nodes.size() * sizeof(TreeNode) + primitive_ids.size() * sizeof(uint32_t);
    }
};

/// A tree, and what forms of it need: builders know it, or add_axes works it out.
struct AxisBvh {
    Bvh bvh;
    std::vector<uint8_t> axes; ///< one a node: of the cut, or compute_axes
    int depth = 0;             ///< of `bvh`
};

/// Axis of each inner node, along which its left child lies below the right one by most; 0 for leaves. Rays
/// that go backwards along it take the right child first.
std::vector<uint8_t> compute_axes(const Bvh& bvh);

/// In parallel.
LinkedBvh make_linked_bvh(const AxisBvh& tree);

/// Edges on the longest way from the root to a leaf, in parallel; 0 without nodes.
int compute_depth(const Bvh& bvh);

/// Nodes on level `max_depth` >= 0 become leaves of all primitives below, which stand next to each other.
Bvh limit_depth(const Bvh& bvh, int max_depth);

/// With axes of its own, and its depth.
AxisBvh add_axes(Bvh bvh);
/// The same tree where it is not deeper.
AxisBvh limit_depth(AxisBvh tree, int max_depth);

} // namespace relief
