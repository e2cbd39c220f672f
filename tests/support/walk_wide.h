// Walks a wide tree one child at a time, nearest first, as it is decoded: whether the tree holds what it was
// made from. The engine's own kernels are checked by their hits. Leaves as for lab/walks/walks.h.
#pragma once

#include <array>
#include <limits>

#include "base/check.h"
#include "bvh/wide_bvh.h"
#include "support/slab_ray.h"

namespace relief {

namespace detail {

/// `leaf(primitive_id, ray)` may shorten ray.t_max; true ends the walk. Returns whether a leaf ended it.
template <class Leaf> bool walk_wide(const WideBvh& bvh, BoxRay& ray, Leaf&& leaf) {
    struct Entry {
        uint32_t child;
        float entry;
    };
    constexpr float kMiss = std::numeric_limits<float>::infinity();
    // A wide tree is at most as deep as the binary one; each level leaves up to seven siblings behind.
    std::array<Entry, (WideNode::kMaxChildCount - 1) * kMaxBvhDepth + WideNode::kMaxChildCount> stack;
    int size = 0;
    const SlabRay slab(ray);
    if (slab.compute_entry(bvh.bounds, ray.t_min, ray.t_max) != kMiss) stack[size++] = {0, ray.t_min};
    while (size > 0) {
        const Entry top = stack[--size];
        // Entries are lower bounds up to rounding; the widened interval of the slab test allows for it.
        if (top.entry > ray.t_max * SlabRay::kWiden) continue;
        if (WideNode::is_leaf(top.child)) {
            const uint32_t first = WideNode::leaf_first(top.child);
            for (uint32_t k = 0; k < WideNode::leaf_count(top.child); ++k)
                if (leaf(bvh.primitive_at(first + k), ray)) return true;
            continue;
        }
        const WideNode& node = bvh.nodes[top.child];
        const int first = size;
        DCHECK(size + node.child_count <= int(stack.size()));
        for (int k = 0; k < node.child_count; ++k) {
            const float entry = slab.compute_entry(node.child_box(k), ray.t_min, ray.t_max);
            if (entry == kMiss) continue;
            int place = size++;
            for (; place > first && stack[place - 1].entry < entry; --place) stack[place] = stack[place - 1];
            stack[place] = {node.child[k], entry};
        }
    }
    return false;
}

} // namespace detail

/// As for a binary tree.
template <class Leaf> void closest_hit(const WideBvh& bvh, BoxRay& ray, Leaf&& leaf) {
    detail::walk_wide(bvh, ray, [&](uint32_t id, BoxRay& r) {
        leaf(id, r);
        return false;
    });
}

/// As for a binary tree.
template <class Leaf> bool any_hit(const WideBvh& bvh, BoxRay ray, Leaf&& leaf) {
    return detail::walk_wide(bvh, ray, leaf);
}

} // namespace relief
