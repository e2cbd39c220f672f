// One ray through the two upper levels: wide tree of instances, wide tree of a surface's patches. Nearest
// first, for any-hit too: unordered, the cache of bottom trees would thrash.
#if defined(RELIEF_SCENE_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_SCENE_TRAVERSAL_INL_H
#undef RELIEF_SCENE_TRAVERSAL_INL_H
#else
#define RELIEF_SCENE_TRAVERSAL_INL_H
#endif

#include "base/check.h"
#include "base/timer.h"
#include "engine/cpu/patch_traversal-inl.h"
#include "engine/cpu/polygon_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

HWY_INLINE LaneMask test_node(const WideNode& node, const RayState& ray, Lanes8& entry) {
    Lanes8 bound[6];
    decode_node(node, bound);
    return test_boxes(bound, ray, entry) & ((1u << node.child_count) - 1);
}

/// Walks the subtree of `root` (a child word; 0 is the whole tree) and calls visit(primitive, entry) until it
/// is true.
template <class Visit>
HWY_INLINE bool walk_tree(const WideBvh& tree, cpu::TraceContext& context, uint32_t root, const RayState& ray,
                          Visit visit) {
    if (tree.nodes.empty()) return false;
    StackEntry stack[kStackSize];
    uint32_t size = 0;
    stack[size++] = {root, ray.t_min};
    while (size > 0) {
        const StackEntry top = stack[--size];
        if (top.entry > ray.t_max * kBoxSlack) continue;
        if (WideNode::is_leaf(top.child)) {
            const uint32_t first = WideNode::leaf_first(top.child), count = WideNode::leaf_count(top.child);
            for (uint32_t k = 0; k < count; ++k)
                if (visit(tree.primitive_at(first + k), top.entry)) return true;
            continue;
        }
        const WideNode& node = tree.nodes[top.child];
        Lanes8 entry;
        ++context.counters.upper_nodes;
        LaneMask mask = test_node(node, ray, entry);
        alignas(32) float distance[8];
        entry.store(distance);
        DCHECK(size + 8 <= kStackSize);
        const uint32_t base = size;
        for (; mask; mask &= mask - 1) {
            const uint32_t k = uint32_t(__builtin_ctz(mask));
            uint32_t slot = size++;
            for (; slot > base && stack[slot - 1].entry < distance[k]; --slot) stack[slot] = stack[slot - 1];
            stack[slot] = {node.child[k], distance[k]};
        }
    }
    return false;
}

/// An undisplaced quad or triangle: lane 0 is (0, 1, 2), lane 1 is (0, 2, 3).
template <Query kQuery> bool trace_polygon(const Surface& surface, uint32_t patch, RayState& ray) {
    const Quad& quad = surface.quads[patch];
    static constexpr uint8_t kCorner[3][2] = {{0, 0}, {1, 2}, {2, 3}};
    Lanes4 x[3], y[3], z[3];
    for (int corner = 0; corner < 3; ++corner) {
        alignas(16) float coordinate[3][4];
        for (int lane = 0; lane < 4; ++lane) {
            const Vec3f& p = surface.positions[quad.vertex[kCorner[corner][lane & 1]]];
            coordinate[0][lane] = p.x, coordinate[1][lane] = p.y, coordinate[2][lane] = p.z;
        }
        const Lanes4 vertex[3] = {Lanes4::load(coordinate[0]), Lanes4::load(coordinate[1]),
                                  Lanes4::load(coordinate[2])};
        shear_vertices(vertex, ray, x[corner], y[corner], z[corner]);
    }
    TriangleTest<4> test;
    if (!(test_edges(x, y, test) & 3)) return false;
    test_distances(z, ray, test);
    test.mask &= quad.is_triangle() ? 1 : 3;
    if (!test.mask) return false;
    if constexpr (kQuery == Query::closest)
        offer_hits(ray, test, [&](uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
            hit.patch = patch;
            locate_on_polygon(lane != 0, weight_b, weight_c, hit);
        });
    return true;
}

/// One primitive of an instance: a polygon or a displaced patch.
template <Query kQuery>
HWY_INLINE bool trace_primitive(const cpu::SceneView& scene, cpu::TraceContext& context,
                                const cpu::TraceRay& world, uint32_t patch, RayState& ray) {
    const Surface& surface = scene.surfaces[scene.instances[ray.instance].surface];
    if (!surface.has_displacement) return trace_polygon<kQuery>(surface, patch, ray);
    PatchVisit visit = enter_patch(scene, context, ray.instance, patch, world.bias);
    if (scene.lod == LodRule::ray) choose_ray_level(visit, world);
    if (!context.is_timed) return trace_patch<kQuery>(visit, ray);
    const Timer timer;
    const double built_before = context.counters.bottom_build_s;
    const bool has_hit = trace_patch<kQuery>(visit, ray);
    context.counters.sampled_bottom_s += timer.seconds() - (context.counters.bottom_build_s - built_before);
    return has_hit;
}

/// The subtree of `root` of one instance's surface. `ray` is in the object's space.
template <Query kQuery>
bool trace_instance(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                    uint32_t root, RayState& ray) {
    const uint32_t surface = scene.instances[ray.instance].surface;
    if (!scene.surfaces[surface].has_displacement)
        return trace_polygons<kQuery>(scene.polygon_trees[surface], root, ray);
    const WideBvh& tree = scene.surface_trees[surface];
    return walk_tree(tree, context, root, ray, [&](uint32_t patch, float) {
        const bool has_hit = trace_primitive<kQuery>(scene, context, world, patch, ray);
        return kQuery == Query::any && has_hit;
    });
}

/// The whole scene along one ray, from the subtree of `root` of the instance tree. `best` carries t_max and
/// the hit.
template <Query kQuery>
bool trace_scene(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                 uint32_t root, RayState& best) {
    return walk_tree(*scene.instance_tree, context, root, best, [&](uint32_t instance, float) {
        RayState ray = best;
        ray.instance = instance;
        enter_object(world, scene.instances[instance].object_from_world, ray);
        const bool is_hit = trace_instance<kQuery>(scene, context, world, 0, ray);
        best.t_max = ray.t_max;
        best.hit = ray.hit;
        return is_hit;
    });
}

/// The whole scene along one ray; `ray` begins empty. An only instance needs no tree over instances.
template <Query kQuery>
HWY_INLINE bool trace_ray(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                          RayState& ray) {
    ray.t_min = world.t_min, ray.t_max = world.t_max;
    if (scene.instance_count != 1) {
        enter_object(world, Affine{}, ray);
        return trace_scene<kQuery>(scene, context, world, 0, ray);
    }
    ray.instance = 0;
    enter_object(world, scene.instances[0].object_from_world, ray);
    const uint32_t surface = scene.instances[0].surface;
    if (!scene.surfaces[surface].has_displacement)
        return trace_polygons<kQuery>(scene.polygon_trees[surface], 0, ray);
    return trace_instance<kQuery>(scene, context, world, 0, ray);
}

/// A ray as the instance tree sees it, with nothing hit yet.
HWY_INLINE RayState start_ray(const cpu::TraceRay& world) {
    RayState ray;
    ray.t_min = world.t_min, ray.t_max = world.t_max;
    enter_object(world, Affine{}, ray);
    return ray;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
