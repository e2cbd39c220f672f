// Walks a binary tree with a stack, nearest child first. The reference for every other traversal; one leaf
// contract.
#pragma once

#include <array>
#include <limits>
#include <utility>

#include "base/check.h"
#include "structures/bvh.h"
#include "structures/ray_box.h"

namespace relief {

namespace detail {

struct StackEntry {
    uint32_t node;
    float entry;
};

/// `leaf(primitive_id, ray)` may shorten ray.t_max; true ends the walk. Returns whether a leaf ended it.
template <class Leaf> bool walk_stack(const Bvh& bvh, BoxRay& ray, Leaf&& leaf) {
    constexpr float kMiss = std::numeric_limits<float>::infinity();
    if (bvh.nodes.empty()) return false;
    const SlabRay slab(ray);
    const auto enter = [&](uint32_t node) {
        return StackEntry{node, slab.compute_entry(bvh.nodes[node].box(), ray.t_min, ray.t_max)};
    };
    // One entry a level, plus the root.
    std::array<StackEntry, kMaxBvhDepth + 1> stack;
    int size = 0;
    const StackEntry root = enter(0);
    if (root.entry != kMiss) stack[size++] = root;
    while (size > 0) {
        const StackEntry top = stack[--size];
        const BvhNode& node = bvh.nodes[top.node];
        // The interval may have become shorter since the entry was pushed.
        if (top.entry > ray.t_max * SlabRay::kWiden) continue;
        if (node.is_leaf()) {
            for (uint32_t k = 0; k < node.primitive_count; ++k)
                if (leaf(bvh.primitive_ids[node.first + k], ray)) return true;
            continue;
        }
        StackEntry near = enter(node.first), far = enter(node.first + 1);
        if (far.entry < near.entry) std::swap(near, far);
        DCHECK(size + 2 <= int(stack.size()));
        if (far.entry != kMiss) stack[size++] = far;
        if (near.entry != kMiss) stack[size++] = near;
    }
    return false;
}

} // namespace detail

/// Calls `leaf(primitive_id, ray)` for every primitive whose box the ray may meet before ray.t_max; the leaf
/// shortens ray.t_max to its hits. The order of calls is not fixed: where hits tie, the leaf decides.
template <class Leaf> void closest_hit(const Bvh& bvh, BoxRay& ray, Leaf&& leaf) {
    detail::walk_stack(bvh, ray, [&](uint32_t id, BoxRay& r) {
        leaf(id, r);
        return false;
    });
}

/// Whether `leaf(primitive_id, ray)` was true for any primitive; stops at the first.
template <class Leaf> bool any_hit(const Bvh& bvh, BoxRay ray, Leaf&& leaf) {
    return detail::walk_stack(bvh, ray, leaf);
}

} // namespace relief
