// A bundle of rays (ray_bundle-inl.h) through the scene: what the projection of micro-polygons onto the
// picture is in a rasteriser, with every box, patch and block visited once for all rays of a tile, nearest
// first.
#if defined(RELIEF_BUNDLE_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_BUNDLE_TRAVERSAL_INL_H
#undef RELIEF_BUNDLE_TRAVERSAL_INL_H
#else
#define RELIEF_BUNDLE_TRAVERSAL_INL_H
#endif

#include <cstddef>

#include "base/check.h"
#include "cpu/traversal/hit_log-inl.h"
#include "cpu/traversal/packet_traversal-inl.h"
#include "cpu/traversal/ray_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Fewer rays than this are left to packets.
inline constexpr uint32_t kLeastBundle = 64;

/// A patch that a bundle is inside of, and the rays that were tested against its triangles.
struct BundleVisit {
    PatchVisit patch;
    LaneMask tested[kGroupCount] = {}, hit[kGroupCount] = {};

    static uint32_t count(const LaneMask (&bits)[kGroupCount]) {
        uint32_t sum = 0;
        for (const LaneMask group : bits) sum += uint32_t(__builtin_popcount(group));
        return sum;
    }
};

/// Places of hits on the quads of a block.
struct QuadPlaces {
    HitPlaces places;
    int32_t first; ///< cell of the block

    HWY_INLINE QuadPlaces(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block) {
        uint32_t column = 0, row = 0;
        cpu::BottomTree::block_cell(int(tree.level), block, column, row);
        first = int32_t((tree.cell_x + column) | (tree.cell_y + row) << 16);
        places.patch = LaneIndices(int32_t(visit.patch)), places.levels = visit.levels;
        places.cell_size = visit.cell_size();
    }
    /// `upper` is HitPlaces::kUpper or 0. Quads 4 to 7 are those of the second row.
    HWY_INLINE const HitPlaces& locate(const LaneIndices& quad, uint32_t upper) {
        places.cell =
            LaneIndices(int32_t(uint32_t(first) | upper)) + quad.masked(3) + quad.masked(4).shifted_up<14>();
        return places;
    }
};

template <size_t W>
HWY_INLINE void measure_from(const Vec3f& origin, const Lanes<W> (&vertex)[3], Lanes<W> (&v)[3]) {
    v[0] = vertex[0] - Lanes<W>(origin.x), v[1] = vertex[1] - Lanes<W>(origin.y);
    v[2] = vertex[2] - Lanes<W>(origin.z);
}

/// The window of the vertices of a block; `v` is relative to the bundle's origin.
template <class Bundle> HWY_INLINE Window find_block_window(const Lanes16 (&v)[3], const Bundle& bundle) {
    Lanes16 vertex[3];
    for (int k = 0; k < 3; ++k) vertex[k] = hide_last(v[k]);
    return find_window(vertex, bundle);
}

/// A window about all.
HWY_INLINE Window find_union(const PartWindows& part) {
    return {reduce_min(part.lower_x), reduce_max(part.upper_x), reduce_min(part.lower_y),
            reduce_max(part.upper_y), reduce_min(part.depth),   reduce_max(part.far)};
}

/// The triangles of a block, for each ray that may meet one.
template <class Bundle>
HWY_NOINLINE void trace_block(BundleVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                              Bundle& bundle) {
    const BlockPlace place(tree, int(tree.level), block);
    const Lanes16 vertex[3] = {place.load(0), place.load(1), place.load(2)};
    Lanes16 seen_from[3], v[3];
    measure_from(bundle.origin, vertex, seen_from);
    // A fan's groups are narrow: few blocks that it reaches concern none.
    Window all;
    if constexpr (Bundle::kIsWide) {
        all = find_block_window(seen_from, bundle);
        if (!find_groups(all, bundle)) return;
    }
    const PartWindows windows = find_quad_windows(seen_from, bundle);
    if constexpr (!Bundle::kIsWide) all = find_union(windows);
    measure_from(bundle.vertex_origin(), vertex, v);
    BlockHits<Bundle> hits(bundle, visit.hit);
    QuadPlaces quads(visit.patch, tree, block);
    const LaneTable<16> table[3] = {LaneTable<16>(v[0]), LaneTable<16>(v[1]), LaneTable<16>(v[2])};
    visit_pairs(
        windows, all, bundle, visit.tested,
        visit.patch.context->counters.blocks, [&](PairsOf<Bundle> & list) __attribute__((always_inline)) {
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
}

struct BundleEntry {
    uint32_t child;
    float nearest;
};

/// Calls visit(child) for the lanes of `mask`, nearest first.
template <size_t W, class Visit>
HWY_INLINE void visit_in_order(LaneMask mask, const Lanes<W>& nearest, const RayBundle& bundle, Visit visit) {
    alignas(64) float depth[W];
    nearest.store(depth);
    BundleEntry order[W];
    uint32_t count = 0;
    for (; mask; mask &= mask - 1) {
        const uint32_t child = uint32_t(__builtin_ctz(mask));
        uint32_t slot = count++;
        for (; slot > 0 && order[slot - 1].nearest > depth[child]; --slot) order[slot] = order[slot - 1];
        order[slot] = {child, depth[child]};
    }
    for (uint32_t k = 0; k < count && order[k].nearest * kDepthSlack <= bundle.farthest; ++k)
        visit(order[k].child);
}

/// Calls visit(child) for the boxes of a node that the bundle reaches, nearest first.
template <size_t W, class Bundle, class Visit>
HWY_INLINE void visit_boxes(const float (&bounds)[6][W], const Bundle& bundle, Visit visit) {
    Lanes<W> bound[6], nearest;
    for (int k = 0; k < 6; ++k) bound[k] = Lanes<W>::load(bounds[k]);
    const LaneMask mask = test_boxes(bound, bundle, nearest);
    visit_in_order(mask, nearest, bundle, visit);
}

template <class Bundle>
HWY_INLINE void trace_tree(BundleVisit& visit, const cpu::BottomTree& tree, Bundle& bundle) {
    uint64_t& nodes = visit.patch.context->counters.patch_nodes;
    const auto test_block = [&](uint32_t block) { trace_block(visit, tree, block, bundle); };
    const auto test_square = [&](uint32_t square) { test_block(2 * square), test_block(2 * square + 1); };
    nodes += tree.level >= 3;
    if (tree.level == 6) {
        visit_boxes(tree.root().bounds, bundle, [&](uint32_t g) {
            ++nodes;
            visit_boxes(tree.wide_group(int(g)).bounds, bundle, [&](uint32_t k) { test_square(g * 16 + k); });
        });
    } else if (tree.level == 5) {
        visit_boxes(tree.root().bounds, bundle, [&](uint32_t g) {
            ++nodes;
            visit_boxes(tree.group(int(g)).bounds, bundle, [&](uint32_t k) { test_block(g * 8 + k); });
        });
    } else if (tree.level == 4) {
        visit_boxes(tree.root().bounds, bundle, test_square);
    } else if (tree.level == 3) {
        visit_boxes(tree.group(0).bounds, bundle, test_block);
    } else {
        for (uint32_t block = 0; block < cpu::BottomTree::block_count(int(tree.level)); ++block)
            test_block(block);
    }
}

template <class Bundle>
void trace_directory(BundleVisit& visit, const cpu::TileDirectory& directory, uint32_t step, uint32_t x,
                     uint32_t y, Bundle& bundle) {
    using cpu::TileDirectory;
    const uint32_t depth = directory.depth, fanout = TileDirectory::fanout(depth, step);
    const uint32_t side = TileDirectory::step_side(depth, step);
    const cpu::Node16& node = directory.nodes()[TileDirectory::step_begin(depth, step) + y * side + x];
    const bool is_last = step + 1 == TileDirectory::step_count(depth);
    uint32_t visited = 0; // a bit a tile
    ++visit.patch.context->counters.patch_nodes;
    visit_boxes(node.bounds, bundle, [&](uint32_t child) {
        const uint32_t cx = x * fanout + child % fanout, cy = y * fanout + child / fanout;
        if (!is_last) {
            trace_directory(visit, directory, step + 1, cx, cy, bundle);
        } else if (const uint32_t bit = 1u << TileDirectory::find_tile_of_node(child); !(visited & bit)) {
            visited |= bit;
            const uint32_t tile = TileDirectory::find_tile(depth, cx, cy);
            trace_tree(visit, find_tree(visit.patch, tile), bundle);
        }
    });
}

template <class Bundle>
void trace_patch(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t patch, Bundle& bundle) {
    BundleVisit visit{enter_patch(scene, context, bundle.instance, patch, bundle.rays->bias)};
    const std::optional<Timer> timer = context.is_timed ? std::optional<Timer>(std::in_place) : std::nullopt;
    const double built_before = context.counters.bottom_build_s;
    if (visit.patch.level() <= cpu::kTileLevel)
        trace_tree(visit, find_tree(visit.patch, 0), bundle);
    else
        trace_directory(visit, find_directory(visit.patch), 0, 0, 0, bundle);
    context.counters.pairs_emitted += uint64_t(BundleVisit::count(visit.tested)) - 1;
    context.counters.pairs_with_hit += BundleVisit::count(visit.hit);
    if (context.is_timed)
        context.counters.sampled_bottom_s +=
            timer->seconds() - (context.counters.bottom_build_s - built_before);
}

/// Bounds of the children of a quantised node, by the decoder that the builder checked with.
HWY_INLINE void load_bounds(const WideNode& node, Lanes8 (&bound)[6]) {
    for (int k = 0; k < 3; ++k) {
        const float scale = WideNode::decode_scale(node.exponent[k]);
        bound[k] = Lanes8::decode(node.planes[k], node.origin[k], scale);
        bound[3 + k] = Lanes8::decode(node.planes[3 + k], node.origin[k], scale);
    }
}
HWY_INLINE void load_bounds(const cpu::PolygonNode& node, Lanes8 (&bound)[6]) {
    for (int k = 0; k < 6; ++k) bound[k] = Lanes8::load(node.bounds[k]);
}

/// The window of box k of eight.
template <class Bundle>
HWY_INLINE Window find_window(const Lanes8 (&bound)[6], uint32_t k, const Bundle& bundle) {
    alignas(32) float planes[6][8], corner[3][8];
    for (int plane = 0; plane < 6; ++plane) bound[plane].store(planes[plane]);
    const float origin[3] = {bundle.origin.x, bundle.origin.y, bundle.origin.z};
    for (uint32_t c = 0; c < 3; ++c)
        for (uint32_t which = 0; which < 8; ++which)
            corner[c][which] = planes[(which >> c & 1) != 0 ? 3 + c : c][k] - origin[c];
    const Lanes8 v[3] = {Lanes8::load(corner[0]), Lanes8::load(corner[1]), Lanes8::load(corner[2])};
    return find_window(v, bundle);
}

struct WalkEntry {
    uint32_t child;
    float nearest;
    uint32_t parent, slot; ///< the node and its slot that name the child
};

/// Calls visit(child, window) for the leaves of a tree of wide nodes that rays may meet something nearer in,
/// nearest first. Returns how many nodes were visited.
template <class Nodes, class Bundle, class Visit>
HWY_INLINE uint32_t walk_bundle(const Nodes& nodes, const Bundle& bundle, Visit visit) {
    using Node = typename Nodes::value_type;
    if (nodes.empty()) return 0;
    WalkEntry stack[kStackSize];
    uint32_t size = 0, visited = 0;
    stack[size++] = {0, 0, 0, 0};
    while (size > 0) {
        const WalkEntry top = stack[--size];
        if (top.nearest * kDepthSlack > bundle.farthest) continue;
        Lanes8 bound[6], nearest;
        if (Node::is_leaf(top.child)) {
            load_bounds(nodes[top.parent], bound);
            const Window window = find_window(bound, top.slot, bundle);
            if (find_groups(window, bundle)) visit(top.child, window);
            continue;
        }
        const Node& node = nodes[top.child];
        ++visited;
        load_bounds(node, bound);
        LaneMask mask = test_boxes(bound, bundle, nearest) & ((1u << count_children(node)) - 1);
        alignas(32) float depth[8];
        nearest.store(depth);
        const uint32_t base = size;
        DCHECK(size + 8 <= kStackSize);
        for (; mask; mask &= mask - 1) {
            const uint32_t k = uint32_t(__builtin_ctz(mask));
            uint32_t slot = size++;
            for (; slot > base && stack[slot - 1].nearest < depth[k]; --slot) stack[slot] = stack[slot - 1];
            stack[slot] = {node.child[k], depth[k], top.child, k};
        }
    }
    return visited;
}

/// Eight triangles of a surface without displacement; lanes without one are NaN, and no ray meets them.
template <class Bundle>
HWY_NOINLINE void trace_block(const cpu::TriangleBlock& block, const Window& window, Bundle& bundle) {
    Lanes8 corners[3][3], v[3][3];
    for (int c = 0; c < 3; ++c) {
        for (int axis = 0; axis < 3; ++axis) corners[c][axis] = Lanes8::load(block.corner[c][axis]);
        measure_from(bundle.origin, corners[c], v[c]);
    }
    const PartWindows windows = find_triangle_windows(v, bundle);
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
    visit_pairs(windows, window, bundle, tested, count, [&](PairsOf<Bundle>& list) {
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

/// An instance in whose space the rays are no bundle: one after another.
inline void trace_singly(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance,
                         BundleRays& rays) {
    for (uint32_t k = 0; k < rays.count; ++k) {
        const cpu::TraceRay world{rays.origin_of(k), rays.t_min[k], rays.direction_of(k), rays.t[k],
                                  rays.bias};
        RayState ray;
        ray.t_min = world.t_min, ray.t_max = world.t_max;
        if (rays.found[k] == kWritten) ray.hit = rays.hits[k];
        ray.hit.bias = uint8_t(rays.bias);
        ray.instance = instance;
        enter_object(world, scene.instances[instance].object_from_world, ray);
        trace_instance<Query::closest>(scene, context, world, 0, ray);
        rays.t[k] = ray.t_max;
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
        walk_bundle(tree.nodes, bundle, [&](uint32_t leaf, const Window& window) {
            trace_block(tree.blocks[cpu::PolygonNode::leaf_block(leaf)], window, bundle);
        });
    } else {
        const WideBvh& tree = scene.surface_trees[surface];
        context.counters.upper_nodes += walk_bundle(tree.nodes, bundle, [&](uint32_t leaf, const Window&) {
            const uint32_t first = WideNode::leaf_first(leaf), count = WideNode::leaf_count(leaf);
            for (uint32_t k = 0; k < count; ++k)
                trace_patch(scene, context, tree.primitive_at(first + k), bundle);
        });
    }
    write_hits(bundle);
}

/// The same from another space. False, with nothing done, where the rays are no bundle in that of the
/// instance.
template <class Bundle>
bool enter_instance(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance,
                    BundleRays& rays) {
    Bundle bundle;
    bundle.rays = &rays, bundle.instance = instance;
    if (!enter_space(scene.instances[instance].object_from_world, bundle)) return false;
    trace_instance(scene, context, bundle);
    return true;
}

/// Everything of all instances, into found and hits. False where the rays are no bundle.
template <class Bundle>
bool trace_instances(const cpu::SceneView& scene, cpu::TraceContext& context, BundleRays& rays) {
    if (scene.instance_count == 1) return enter_instance<Bundle>(scene, context, 0, rays);
    Bundle world;
    world.rays = &rays;
    if (!enter_space(Affine{}, world)) return false;
    const auto trace = [&](uint32_t instance) {
        if (!scene.is_visible(instance)) return;
        if (scene.instances[instance].is_in_place) {
            world.instance = instance;
            return trace_instance(scene, context, world);
        }
        if (!enter_instance<Bundle>(scene, context, instance, rays))
            trace_singly(scene, context, instance, rays);
        for (uint32_t group = 0; group < kGroupCount; ++group)
            world.group_farthest[group] = find_farthest(world, group);
        update_farthest(world);
    };
    context.counters.upper_nodes +=
        walk_bundle(scene.instance_tree->nodes, world, [&](uint32_t leaf, const Window&) {
            const uint32_t first = WideNode::leaf_first(leaf), size = WideNode::leaf_count(leaf);
            for (uint32_t k = 0; k < size; ++k) trace(scene.instance_tree->primitive_at(first + k));
        });
    return true;
}

/// Nearest hits of the rays, as a RayFan or RayShaft; fill_rest comes before. False where they are no bundle;
/// `hits` is undefined then.
template <class Bundle>
bool trace_bundle(const cpu::SceneView& scene, cpu::TraceContext& context, BundleRays& rays,
                  cpu::TraceHit* hits) {
    HitLog log;
    rays.hits = hits, rays.log = &log;
    std::fill_n(rays.found, kBundleSize, kNothing);
    if (!trace_instances<Bundle>(scene, context, rays)) return false;
    cpu::TraceHit none;
    none.bias = uint8_t(rays.bias);
    for (uint32_t k = 0; k < rays.count; ++k)
        if (rays.found[k] == kNothing) hits[k] = none;
    return true;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
