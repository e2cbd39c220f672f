// A bundle of rays (ray_bundle-inl.h) through the scene: as in a rasteriser of micro-polygons, every box,
// patch and block is visited once for all rays of a tile, nearest first.
#pragma once

#include <cstddef>

#include "base/check.h"
#include "cpu/traversal/hit_log-inl.h"
#include "cpu/traversal/packet_traversal-inl.h"
#include "cpu/traversal/ray_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Fewer rays than this are left to packets.
inline constexpr uint32_t kLeastBundle = 64;

/// Places of hits on the quads of a block.
struct QuadPlaces {
    HitPlaces places;
    int32_t first; ///< cell of the block

    RELIEF_INLINE QuadPlaces(const PatchVisit& visit, const cpu::PatchTree& tree, uint32_t block) {
        uint32_t column = 0, row = 0;
        cpu::PatchTree::block_cell(int(tree.level), block, column, row);
        first = int32_t((tree.cell_x + column) | (tree.cell_y + row) << 16);
        places.patch = LaneIndices(int32_t(visit.patch)), places.levels = visit.levels;
        places.cell_size = visit.cell_size();
    }
    /// `upper` is HitPlaces::kUpper or 0. Quads 4 to 7 are those of the second row.
    RELIEF_INLINE const HitPlaces& locate(const LaneIndices& quad, uint32_t upper) {
        places.cell =
            LaneIndices(int32_t(uint32_t(first) | upper)) + quad.masked(3) + quad.masked(4).shifted_up<14>();
        return places;
    }
};

template <size_t W>
RELIEF_INLINE void measure_from(const Vec3f& origin, const Lanes<W> (&vertex)[3], Lanes<W> (&v)[3]) {
    v[0] = vertex[0] - Lanes<W>(origin.x), v[1] = vertex[1] - Lanes<W>(origin.y);
    v[2] = vertex[2] - Lanes<W>(origin.z);
}

/// Of the vertices of a block; `v` is relative to the bundle's origin.
template <class Bundle>
RELIEF_INLINE ProjectedBounds find_block_bounds(const Lanes16 (&v)[3], const Bundle& bundle) {
    Lanes16 vertex[3];
    for (int k = 0; k < 3; ++k) vertex[k] = hide_last(v[k]);
    return find_bounds(vertex, bundle);
}

/// Bounds of all.
RELIEF_INLINE ProjectedBounds find_union(const PartBounds& part) {
    return {reduce_min(part.lower_x), reduce_max(part.upper_x), reduce_min(part.lower_y),
            reduce_max(part.upper_y), reduce_min(part.depth),   reduce_max(part.far)};
}

inline uint32_t count_rays(const LaneMask (&bits)[kGroupCount]) {
    uint32_t sum = 0;
    for (const LaneMask group : bits) sum += uint32_t(__builtin_popcount(group));
    return sum;
}

/// A bundle inside a patch, and the rays that were tested against its triangles.
template <class Bundle> struct BundleProbe {
    static constexpr bool kListsLeaves = false;

    PatchVisit visit;
    Bundle& bundle;
    LaneMask tested[kGroupCount] = {}, hit[kGroupCount] = {};

    template <size_t W, class Visit>
    RELIEF_INLINE bool visit_children(const float (&bounds)[6][W], LaneMask rays, Visit visit_child) {
        Lanes<W> bound[6], nearest;
        for (int k = 0; k < 6; ++k) bound[k] = Lanes<W>::load(bounds[k]);
        LaneMask mask = test_boxes(bound, bundle, nearest);
        alignas(64) float depth[W];
        nearest.store(depth);
        StackEntry order[W];
        uint32_t count = 0;
        for (; mask; mask &= mask - 1) {
            const uint32_t child = uint32_t(__builtin_ctz(mask));
            insert_sorted<kNearestFirst>({child, depth[child]}, order, count);
        }
        for (uint32_t k = 0; k < count && order[k].entry * kDepthSlack <= bundle.farthest[kGroupCount]; ++k)
            visit_child(order[k].child, rays);
        return false;
    }

    void count_pairs(LaneMask) const { visit.count_pairs(count_rays(tested), count_rays(hit)); }

    /// The triangles of a block, for each ray that may meet one.
    HWY_NOINLINE bool test_block(const cpu::PatchTree& tree, int level, uint32_t block, LaneMask) {
        const BlockPlace place(tree, level, block);
        const Lanes16 vertex[3] = {place.load(0), place.load(1), place.load(2)};
        Lanes16 seen_from[3], v[3];
        measure_from(bundle.origin, vertex, seen_from);
        // A frustum's groups are narrow: few blocks that it reaches concern none.
        ProjectedBounds all;
        if constexpr (Bundle::kIsWide) {
            all = find_block_bounds(seen_from, bundle);
            if (!find_groups(all, bundle)) return false;
        }
        const PartBounds parts = find_quad_bounds(seen_from, bundle);
        if constexpr (!Bundle::kIsWide) all = find_union(parts);
        measure_from(bundle.vertex_origin(), vertex, v);
        BlockHits<Bundle> hits(bundle, hit);
        QuadPlaces quads(visit, tree, block);
        const LaneTable<16> table[3] = {LaneTable<16>(v[0]), LaneTable<16>(v[1]), LaneTable<16>(v[2])};
        visit_pairs(
            parts, all, bundle, tested,
            visit.context->counters.blocks, [&](PairsOf<Bundle> & list) __attribute__((always_inline)) {
                const PairLanes<Bundle::kPairValues> pairs(list);
                // Rows of five vertices, four quads wide; corners 00, 10, 11, 01.
                const LaneIndices quad = pairs.part, base = quad + quad.shifted_down<2>();
                const LaneIndices at[4] = {base, base + LaneIndices(1), base + LaneIndices(6),
                                           base + LaneIndices(5)};
                Lanes16 corner[3][4];
                shear_corners(
                    pairs, bundle, [&](int c, int axis) { return table[axis].pick(at[c]); }, corner);
                TriangleTest<16> test;
                if (test_pairs<1, 2>(pairs, corner, test))
                    hits.note(test, pairs.ray, quads.locate(pairs.part, 0));
                if (test_pairs<2, 3>(pairs, corner, test))
                    hits.note(test, pairs.ray, quads.locate(pairs.part, HitPlaces::kUpper));
            });
        hits.offer();
        return false;
    }
};

/// The boxes of a node, and the slots in use: a bundle may enter an empty box.
template <class Node, size_t W> RELIEF_INLINE void load_bounds(const Node& node, Lanes<W> (&bound)[6]) {
    for (int k = 0; k < 6; ++k) bound[k] = load_plane(node, k, k % 3);
}
RELIEF_INLINE LaneMask find_used(const WideNode& node) { return mask_children(node); }
RELIEF_INLINE LaneMask find_used(const cpu::PolygonNode& node) {
    LaneMask used = 0;
    for (uint32_t k = 0; k < 8; ++k) used |= LaneMask(node.child[k] != WideChild::kNoChild) << k;
    return used;
}

/// Of box k of eight.
template <class Bundle>
RELIEF_INLINE ProjectedBounds find_bounds(const Lanes8 (&bound)[6], uint32_t k, const Bundle& bundle) {
    alignas(32) float planes[6][8], corner[3][8];
    for (int plane = 0; plane < 6; ++plane) bound[plane].store(planes[plane]);
    const float origin[3] = {bundle.origin.x, bundle.origin.y, bundle.origin.z};
    for (uint32_t c = 0; c < 3; ++c)
        for (uint32_t which = 0; which < 8; ++which)
            corner[c][which] = planes[(which >> c & 1) != 0 ? 3 + c : c][k] - origin[c];
    const Lanes8 v[3] = {Lanes8::load(corner[0]), Lanes8::load(corner[1]), Lanes8::load(corner[2])};
    return find_bounds(v, bundle);
}

struct BundleEntry {
    uint32_t child;
    float entry;           ///< least depth
    uint32_t parent, slot; ///< the node and its slot that name the child
};

/// A bundle in a wide tree: leaves that rays may meet something nearer in.
template <class Nodes, class Bundle> struct BundleWalker {
    using Entry = BundleEntry;
    using Node = typename Nodes::value_type;

    const Nodes& nodes;
    const Bundle& bundle;
    ProjectedBounds bounds{}; ///< of the leaf

    RELIEF_INLINE bool enter(const BundleEntry& top) {
        if (top.entry * kDepthSlack > bundle.farthest[kGroupCount]) return false;
        if (!Node::is_leaf(top.child)) return true;
        Lanes8 bound[6];
        load_bounds(nodes[top.parent], bound);
        bounds = find_bounds(bound, top.slot, bundle);
        return find_groups(bounds, bundle) != 0;
    }
    RELIEF_INLINE bool open(const Node& node, BundleEntry& top, BundleEntry* stack, uint32_t& size) {
        Lanes8 bound[6], nearest;
        load_bounds(node, bound);
        LaneMask mask = test_boxes(bound, bundle, nearest) & find_used(node);
        alignas(32) float depth[8];
        nearest.store(depth);
        uint32_t count = 0;
        for (; mask; mask &= mask - 1) {
            const uint32_t k = uint32_t(__builtin_ctz(mask));
            insert_sorted<kFarthestFirst>({node.child[k], depth[k], top.child, k}, stack + size, count);
        }
        size += count;
        return false;
    }
};
template <class Nodes, class Bundle> BundleWalker(const Nodes&, const Bundle&) -> BundleWalker<Nodes, Bundle>;

/// Eight triangles of a surface without displacement; lanes without one are NaN, and no ray meets them.
template <class Bundle>
HWY_NOINLINE void trace_block(const cpu::TriangleBlock& block, const ProjectedBounds& all, Bundle& bundle) {
    Lanes8 corners[3][3], v[3][3];
    for (int c = 0; c < 3; ++c) {
        for (int axis = 0; axis < 3; ++axis) corners[c][axis] = Lanes8::load(block.corner[c][axis]);
        measure_from(bundle.origin, corners[c], v[c]);
    }
    const PartBounds parts = find_triangle_bounds(v, bundle);
    for (int c = 0; c < 3; ++c) measure_from(bundle.vertex_origin(), corners[c], v[c]);
    using Table = LaneTable<8>;
    const Table table[3][3] = {{Table(v[0][0]), Table(v[0][1]), Table(v[0][2])},
                               {Table(v[1][0]), Table(v[1][1]), Table(v[1][2])},
                               {Table(v[2][0]), Table(v[2][1]), Table(v[2][2])}};
    LaneMask tested[kGroupCount] = {}, hit_rays[kGroupCount] = {};
    uint64_t count = 0;
    BlockHits<Bundle> hits(bundle, hit_rays);
    static_assert(offsetof(cpu::TriangleBlock, triangle) % 32 == 0);
    const Table triangles(Lanes8::load(reinterpret_cast<const float*>(block.triangle)));
    visit_pairs(parts, all, bundle, tested, count, [&](PairsOf<Bundle>& list) {
        const PairLanes<Bundle::kPairValues> pairs(list);
        Lanes16 corner[3][3];
        shear_corners(
            pairs, bundle, [&](int c, int axis) { return table[c][axis].pick(pairs.part); }, corner);
        TriangleTest<16> test;
        if (!test_pairs<1, 2>(pairs, corner, test)) return;
        const LaneIndices triangle(triangles.pick(pairs.part));
        hits.note(test, pairs.ray,
                  {triangle.shifted_down<1>(), triangle.masked(1).shifted_up<31>(), 0, 1.0f});
    });
    hits.offer();
}

/// An instance in whose space the rays are no bundle: one after another, those that may meet `bounds`.
template <class Bundle>
void trace_singly(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance,
                  const Bundle& world_bundle, const ProjectedBounds& bounds) {
    BundleRays& rays = *world_bundle.rays;
    LaneMask left[kGroupCount] = {};
    for (LaneMask groups = find_groups(bounds, world_bundle); groups; groups &= groups - 1) {
        const uint32_t group = uint32_t(__builtin_ctz(groups));
        left[group] = load_lanes(world_bundle, group).find_inside(bounds) & rays.group_mask(group);
    }
    for (uint32_t k = 0; k < rays.count; ++k) {
        if (!(left[k / kGroupSize] >> k % kGroupSize & 1)) continue;
        const cpu::TraceRay world{rays.origin_of(k), rays.t_min[k], rays.direction_of(k), rays.t[k],
                                  rays.lod_bias};
        RayState ray;
        ray.t_min = world.t_min, ray.t_max = world.t_max;
        if (rays.found[k] == kWritten) ray.hit = rays.hits[k];
        ray.hit.lod_bias = uint8_t(rays.lod_bias);
        ray.instance = instance;
        enter_object(world, scene.instances[instance], ray);
        trace_instance<Query::closest>(scene, context, world, 0, ray);
        rays.t[k] = ray.hit_t_max();
        if (!ray.hit.is_hit()) continue;
        rays.hits[k] = ray.hit, rays.found[k] = kWritten;
    }
}

/// Everything of the instance in whose space the bundle is.
template <class Bundle>
void trace_instance(const cpu::SceneView& scene, cpu::TraceContext& context, Bundle& bundle) {
    DCHECK(bundle.rays->log->count == 0);
    const uint32_t surface = scene.instances[bundle.instance].surface;
    if (!scene.surfaces[surface].has_displacement) {
        const cpu::PolygonTree& tree = scene.polygon_trees[surface];
        BundleWalker walker{tree.nodes, bundle};
        uint32_t visited = 0;
        walk_wide_tree(tree.nodes, walker, {}, visited, [&](const BundleEntry& leaf) {
            trace_block(tree.blocks[cpu::PolygonNode::leaf_first(leaf.child)], walker.bounds, bundle);
            return false;
        });
    } else {
        const WideBvh& tree = scene.surface_trees[surface];
        BundleWalker walker{tree.nodes, bundle};
        walk_primitives(tree, context, walker, {}, [&](uint32_t patch, const BundleEntry&) {
            BundleProbe<Bundle> probe{{scene, context, bundle.instance, patch, bundle.rays->lod_bias},
                                      bundle};
            visit_patch(probe, 1);
            return false;
        });
    }
    write_hits(bundle);
}

/// Everything of all instances; `world` is in world space.
template <class Bundle>
void trace_instances(const cpu::SceneView& scene, cpu::TraceContext& context, Bundle& world) {
    BundleWalker walker{scene.instance_tree->nodes, world};
    walk_primitives(*scene.instance_tree, context, walker, {}, [&](uint32_t instance, const BundleEntry&) {
        if (!scene.is_visible(instance)) return false;
        const Instance& placed = scene.instances[instance];
        const bool is_far = is_any_far_away(*world.rays, placed);
        if (placed.is_in_place && !is_far) {
            world.instance = instance;
            trace_instance(scene, context, world);
            return false;
        }
        Bundle local;
        local.rays = world.rays, local.instance = instance;
        if (!is_far && enter_space(placed.object_space, local))
            trace_instance(scene, context, local);
        else
            trace_singly(scene, context, instance, world, walker.bounds);
        for (uint32_t group = 0; group < kGroupCount; ++group)
            world.farthest[group] = find_farthest(world, group);
        join_upper(world.farthest);
        return false;
    });
}

/// Nearest hits of the rays, as a RayFrustum or ParallelBeam; pad_inactive_lanes comes before. False where
/// they are no bundle; `hits` is undefined then. An only instance needs no tree over instances.
template <class Bundle>
bool trace_bundle(const cpu::SceneView& scene, cpu::TraceContext& context, BundleRays& rays,
                  cpu::TraceHit* hits) {
    HitLog log;
    rays.hits = hits, rays.log = &log;
    std::fill_n(rays.found, kBundleSize, kNothing);
    Bundle bundle;
    bundle.rays = &rays, bundle.instance = 0;
    const bool is_alone = scene.instance_count == 1;
    if (is_alone && is_any_far_away(rays, scene.instances[0])) return false;
    if (!enter_space(is_alone ? scene.instances[0].object_space : ObjectSpace{}, bundle)) return false;
    if (is_alone)
        trace_instance(scene, context, bundle);
    else
        trace_instances(scene, context, bundle);
    cpu::TraceHit none;
    none.lod_bias = uint8_t(rays.lod_bias);
    for (uint32_t k = 0; k < rays.count; ++k)
        if (rays.found[k] == kNothing) hits[k] = none;
    return true;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
