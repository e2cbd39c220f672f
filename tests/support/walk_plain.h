// Walks a binary tree as it was built, without links or axes, by a full stack.
#pragma once

#include <bit>

#include "lab/walks/walks.h"

namespace relief {

namespace test {

struct PlainWalkView {
    using Key = uint32_t;
    const Bvh& tree;

    bool is_empty() const { return tree.nodes.empty(); }
    TreeNode load_node(uint32_t node) const { return std::bit_cast<TreeNode>(tree.nodes[node]); }
    const std::vector<uint32_t>& primitive_ids() const { return tree.primitive_ids; }
};

} // namespace test

template <class Leaf> void closest_hit(const Bvh& bvh, BoxRay& ray, Leaf&& leaf) {
    closest_hit<TraversalKind::stack>(test::PlainWalkView{bvh}, ray, leaf);
}

template <class Leaf> bool any_hit(const Bvh& bvh, const BoxRay& ray, Leaf&& leaf) {
    return any_hit<TraversalKind::stack>(test::PlainWalkView{bvh}, ray, leaf);
}

} // namespace relief
