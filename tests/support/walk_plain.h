// Walks a binary tree as it was built, without links or axes, by a full stack.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "support/walks_from_root.h"

namespace relief {

namespace test {

/// As the walks read a tree.
struct PlainTree {
    struct Nodes {
        const Bvh& bvh;
        bool empty() const { return bvh.nodes.empty(); }
        TreeNode operator[](uint32_t node) const { return std::bit_cast<TreeNode>(bvh.nodes[node]); }
    };

    explicit PlainTree(const Bvh& bvh) : nodes{bvh}, primitive_ids(bvh.primitive_ids) {}

    const Nodes nodes;
    const std::vector<uint32_t>& primitive_ids;
};

} // namespace test

template <class Leaf> void closest_hit(const Bvh& bvh, BoxRay& ray, Leaf&& leaf) {
    const test::PlainTree tree(bvh);
    closest_hit<TraversalKind::stack>(make_walk_view(tree), ray, leaf);
}

template <class Leaf> bool any_hit(const Bvh& bvh, const BoxRay& ray, Leaf&& leaf) {
    const test::PlainTree tree(bvh);
    return any_hit<TraversalKind::stack>(make_walk_view(tree), ray, leaf);
}

} // namespace relief
