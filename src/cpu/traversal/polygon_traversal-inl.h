// One ray through the tree of a surface without displacement.
#pragma once

#include "cpu/patch_trees/polygon_tree.h"
#include "cpu/traversal/triangle_test-inl.h"
#include "cpu/traversal/wide_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

struct StackEntry {
    uint32_t child;
    float entry;
};

/// Puts the nearer one second, without a branch to guess wrong.
RELIEF_INLINE void order_entries(StackEntry& a, StackEntry& b) {
    const bool is_in_order = a.entry >= b.entry;
    const StackEntry farther = is_in_order ? a : b, nearer = is_in_order ? b : a;
    a = farther, b = nearer;
}

/// The place of a hit on its polygon from the weights of corners b and c. 0 is added as where the cell of a
/// patch is: make_hits does the same for both, and a weight may be -0.
RELIEF_INLINE void locate_on_polygon(bool is_upper, float weight_b, float weight_c, cpu::TraceHit& hit) {
    hit.is_upper = is_upper;
    hit.u = 0.0f + (is_upper ? weight_b : weight_b + weight_c);
    hit.v = 0.0f + (is_upper ? weight_b + weight_c : weight_c);
}

/// Eight triangles at once. Returns whether any was met; Query::closest takes over the nearest.
template <Query kQuery>
RELIEF_INLINE bool intersect_triangles(const cpu::TriangleBlock& block, RayState& ray) {
    Lanes8 x[3], y[3], z[3];
    for (int corner = 0; corner < 3; ++corner)
        shear_vertices([&](int axis) { return Lanes8::load(block.corner[corner][axis]); }, ray, x[corner],
                       y[corner], z[corner]);
    TriangleTest<8> test;
    if (!test_edges(x, y, test)) return false;
    if (!test_distances(x, y, z, ray, test)) return false;
    if constexpr (kQuery == Query::closest)
        offer_hits(ray, test, [&](uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
            hit.patch = block.triangle[lane] / 2;
            locate_on_polygon(block.triangle[lane] % 2 != 0, weight_b, weight_c, hit);
        });
    return true;
}

/// Puts the children of `mask`, at least three, on the stack, the nearest last.
template <class Node>
RELIEF_INLINE void push_children(const Node& node, LaneMask mask, const float* distance, StackEntry* stack,
                                 uint32_t& size) {
    const auto take = [&] {
        const uint32_t k = uint32_t(__builtin_ctz(mask));
        mask &= mask - 1;
        return StackEntry{node.child[k], distance[k]};
    };
    StackEntry a = take(), b = take(), c = take();
    order_entries(a, b), order_entries(b, c), order_entries(a, b);
    StackEntry* const base = stack + size;
    base[0] = a, base[1] = b, base[2] = c;
    uint32_t count = 3;
    while (mask) insert_sorted<kFarthestFirst>(take(), base, count);
    size += count;
}

/// The nearest child of `mask`, at least one; the others go on the stack.
template <class Node>
RELIEF_INLINE uint32_t take_nearest(const Node& node, LaneMask mask, const Lanes8& entry, StackEntry* stack,
                                    uint32_t& size) {
    const uint32_t first = uint32_t(__builtin_ctz(mask));
    const LaneMask others = mask & (mask - 1);
    if (others == 0) return node.child[first];
    alignas(32) float distance[8];
    entry.store(distance);
    if ((others & (others - 1)) == 0) {
        const uint32_t second = uint32_t(__builtin_ctz(others));
        const bool is_first_nearer = distance[first] <= distance[second];
        const uint32_t far = is_first_nearer ? second : first;
        stack[size++] = {node.child[far], distance[far]};
        return node.child[is_first_nearer ? first : second];
    }
    push_children(node, mask, distance, stack, size);
    return stack[--size].child;
}

/// One ray in a tree of polygons: nodes of floats are tested with what is made ready once. Which of two
/// planes a ray meets first is known from its direction; the widening by kBoxSlack is part of the far
/// factors.
struct PolygonRayWalker {
    using Entry = StackEntry;

    const RayState& ray;
    Lanes8 near_origin[3], far_origin[3], near_factor[3], far_factor[3], t_min;
    float reach = 0;

    RELIEF_INLINE explicit PolygonRayWalker(const RayState& of) : ray(of), t_min(of.t_min) {
        for (int k = 0; k < 3; ++k) {
            near_origin[k] = Lanes8(ray.near_origin[k]), far_origin[k] = Lanes8(ray.far_origin[k]);
            near_factor[k] = Lanes8(ray.reciprocal[k]);
            far_factor[k] = Lanes8(ray.reciprocal[k] * kBoxSlack);
        }
    }
    RELIEF_INLINE bool enter(const StackEntry& top) {
        reach = ray.t_max * kBoxSlack;
        return top.entry <= reach;
    }
    RELIEF_INLINE bool open(const cpu::PolygonNode& node, StackEntry& top, StackEntry* stack,
                            uint32_t& size) const {
        Lanes8 near[3], far[3];
        for (int k = 0; k < 3; ++k) {
            near[k] = (Lanes8::load(node.bounds[ray.near_plane[k]]) - near_origin[k]) * near_factor[k];
            far[k] = (Lanes8::load(node.bounds[ray.far_plane[k]]) - far_origin[k]) * far_factor[k];
        }
        const Lanes8 entry = max(max(near[0], near[1]), max(near[2], t_min));
        const LaneMask mask = less_equal(entry, min(min(far[0], far[1]), min(far[2], Lanes8(reach))));
        if (mask != 0) top.child = take_nearest(node, mask, entry, stack, size);
        return mask != 0;
    }
};

/// The subtree of `root` (a child word; 0: the whole tree), nearest first. Query::any: true at a hit.
template <Query kQuery> bool trace_polygons(const cpu::PolygonTree& tree, uint32_t root, RayState& ray) {
    const cpu::TriangleBlock* const blocks = tree.blocks.data();
    PolygonRayWalker walker(ray);
    uint32_t visited = 0;
    return walk_wide_tree(
        tree.nodes, walker, {root, ray.t_min},
        visited, [&](const StackEntry& leaf) __attribute__((always_inline)) {
            const bool has_hit =
                intersect_triangles<kQuery>(blocks[cpu::PolygonNode::leaf_first(leaf.child)], ray);
            return kQuery == Query::any && has_hit;
        });
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
