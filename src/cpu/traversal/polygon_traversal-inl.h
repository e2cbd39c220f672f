// One ray through the tree of a surface without displacement.
#if defined(RELIEF_POLYGON_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_POLYGON_TRAVERSAL_INL_H
#undef RELIEF_POLYGON_TRAVERSAL_INL_H
#else
#define RELIEF_POLYGON_TRAVERSAL_INL_H
#endif

#include "base/check.h"
#include "cpu/patch_trees/polygon_tree.h"
#include "cpu/traversal/ray_state-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Depth of a binary tree is bounded far below this, and so is that of the wide one.
inline constexpr uint32_t kStackSize = 1024;

struct StackEntry {
    uint32_t child;
    float entry;
};

/// Puts the nearer one second, without a branch to guess wrong.
HWY_INLINE void order_entries(StackEntry& a, StackEntry& b) {
    const bool is_in_order = a.entry >= b.entry;
    const StackEntry farther = is_in_order ? a : b, nearer = is_in_order ? b : a;
    a = farther, b = nearer;
}

/// The place of a hit on its polygon from the weights of corners b and c. 0 is added as where the cell of a
/// patch is: make_hits does the same for both, and a weight may be -0.
HWY_INLINE void locate_on_polygon(bool is_upper, float weight_b, float weight_c, cpu::TraceHit& hit) {
    hit.is_upper = is_upper;
    hit.u = 0.0f + (is_upper ? weight_b : weight_b + weight_c);
    hit.v = 0.0f + (is_upper ? weight_b + weight_c : weight_c);
}

/// Eight triangles at once. Returns whether any was met; Query::closest takes over the nearest.
template <Query kQuery> HWY_INLINE bool intersect_triangles(const cpu::TriangleBlock& block, RayState& ray) {
    Lanes8 x[3], y[3], z[3];
    for (int corner = 0; corner < 3; ++corner) {
        const auto& coordinates = block.corner[corner];
        z[corner] = Lanes8::load(coordinates[ray.axis[2]]) - Lanes8(ray.origin[ray.axis[2]]);
        x[corner] = (Lanes8::load(coordinates[ray.axis[0]]) - Lanes8(ray.origin[ray.axis[0]])) -
                    Lanes8(ray.shear[0]) * z[corner];
        y[corner] = (Lanes8::load(coordinates[ray.axis[1]]) - Lanes8(ray.origin[ray.axis[1]])) -
                    Lanes8(ray.shear[1]) * z[corner];
    }
    TriangleTest<8> test;
    if (!test_edges(x, y, test)) return false;
    test_distances(z, ray, test);
    if (!test.mask) return false;
    if constexpr (kQuery == Query::closest)
        offer_hits(ray, test, [&](uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
            hit.patch = block.triangle[lane] / 2;
            locate_on_polygon(block.triangle[lane] % 2 != 0, weight_b, weight_c, hit);
        });
    return true;
}

/// Puts the children of `mask`, at least three, on the stack, the nearest on top.
template <class Node>
HWY_INLINE void push_children(const Node& node, LaneMask mask, const float* distance, StackEntry* stack,
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
    size += 3;
    while (mask) {
        const StackEntry next = take();
        StackEntry* slot = stack + size++;
        for (; slot > base && slot[-1].entry < next.entry; --slot) *slot = slot[-1];
        *slot = next;
    }
}

/// The nearest child of `mask`, at least one; the others go on the stack.
template <class Node>
HWY_INLINE uint32_t take_nearest(const Node& node, LaneMask mask, const Lanes8& entry, StackEntry* stack,
                                 uint32_t& size) {
    const uint32_t first = uint32_t(__builtin_ctz(mask));
    const LaneMask others = mask & (mask - 1);
    if (others == 0) return node.child[first];
    alignas(32) float distance[8];
    entry.store(distance);
    DCHECK(size + 8 <= kStackSize);
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

/// What boxes are tested with. Which of two planes a ray meets first is known from its direction; the
/// widening by kBoxSlack is part of the far factors.
struct BoxTest {
    Lanes8 near_origin[3], far_origin[3], near_factor[3], far_factor[3], t_min;
    int near_plane[3];

    HWY_INLINE explicit BoxTest(const RayState& ray) : t_min(ray.t_min) {
        for (int k = 0; k < 3; ++k) {
            const bool is_negative = ray.reciprocal[k] < 0;
            near_plane[k] = is_negative ? 3 + k : k;
            near_origin[k] = Lanes8(is_negative ? ray.upper_origin[k] : ray.lower_origin[k]);
            far_origin[k] = Lanes8(is_negative ? ray.lower_origin[k] : ray.upper_origin[k]);
            near_factor[k] = Lanes8(ray.reciprocal[k]);
            far_factor[k] = Lanes8(ray.reciprocal[k] * kBoxSlack);
        }
    }

    /// Children met before `reach`, and where.
    HWY_INLINE LaneMask run(const cpu::PolygonNode& node, float reach, Lanes8& entry) const {
        Lanes8 near[3], far[3];
        for (int k = 0; k < 3; ++k) {
            near[k] = (Lanes8::load(node.bounds[near_plane[k]]) - near_origin[k]) * near_factor[k];
            far[k] = (Lanes8::load(node.bounds[2 * k + 3 - near_plane[k]]) - far_origin[k]) * far_factor[k];
        }
        entry = max(max(near[0], near[1]), max(near[2], t_min));
        return less_equal(entry, min(min(far[0], far[1]), min(far[2], Lanes8(reach))));
    }
};

/// The subtree of `root` (a child word; 0 is the whole tree), nearest first. Query::any: true at the first
/// hit.
template <Query kQuery> bool trace_polygons(const cpu::PolygonTree& tree, uint32_t root, RayState& ray) {
    if (tree.nodes.empty()) return false;
    const cpu::PolygonNode* const nodes = tree.nodes.data();
    const cpu::TriangleBlock* const blocks = tree.blocks.data();
    const BoxTest test(ray);
    StackEntry stack[kStackSize];
    stack[0] = {root, ray.t_min};
    uint32_t size = 1;
    while (size > 0) {
        const StackEntry top = stack[--size];
        const float reach = ray.t_max * kBoxSlack;
        if (top.entry > reach) continue;
        uint32_t child = top.child;
        while (!cpu::PolygonNode::is_leaf(child)) {
            const cpu::PolygonNode& node = nodes[child];
            Lanes8 entry;
            const LaneMask mask = test.run(node, reach, entry);
            if (mask == 0) break;
            child = take_nearest(node, mask, entry, stack, size);
        }
        if (!cpu::PolygonNode::is_leaf(child)) continue;
        const bool has_hit = intersect_triangles<kQuery>(blocks[cpu::PolygonNode::leaf_block(child)], ray);
        if (kQuery == Query::any && has_hit) return true;
    }
    return false;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
