// One ray through the trees of instances and patches, nearest first, for any-hit too: else trees thrash.
#pragma once

#include "cpu/traversal/patch_traversal-inl.h"
#include "cpu/traversal/polygon_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// One ray in a tree of quantised nodes.
struct RayWalker {
    using Entry = StackEntry;

    const RayState& ray;

    RELIEF_INLINE bool enter(const StackEntry& top) const { return top.entry <= ray.t_max * kBoxSlack; }
    RELIEF_INLINE bool open(const WideNode& node, StackEntry& top, StackEntry* stack, uint32_t& size) const {
        Lanes8 entry;
        const LaneMask mask = test_node(node, ray, entry);
        if (mask != 0) top.child = take_nearest(node, mask, entry, stack, size);
        return mask != 0;
    }
};

/// An undisplaced quad or triangle: lane 0 is (0, 1, 2), lane 1 is (0, 2, 3).
template <Query kQuery> bool trace_polygon(const Surface& surface, uint32_t patch, RayState& ray) {
    const Quad quad = surface.quads[patch];
    static constexpr uint8_t kCorner[3][2] = {{0, 0}, {1, 2}, {2, 3}};
    Lanes4 x[3], y[3], z[3];
    for (int corner = 0; corner < 3; ++corner) {
        alignas(16) float coordinate[3][4];
        for (int lane = 0; lane < 4; ++lane) {
            const Vec3f& p = surface.position(quad.vertex[kCorner[corner][lane & 1]]);
            coordinate[0][lane] = p.x, coordinate[1][lane] = p.y, coordinate[2][lane] = p.z;
        }
        const Lanes4 vertex[3] = {Lanes4::load(coordinate[0]), Lanes4::load(coordinate[1]),
                                  Lanes4::load(coordinate[2])};
        shear_vertices([&](int axis) { return vertex[axis]; }, ray, x[corner], y[corner], z[corner]);
    }
    TriangleTest<4> test;
    if (!(test_edges(x, y, test) & 3)) return false;
    test_distances(x, y, z, ray, test);
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
RELIEF_INLINE bool trace_primitive(const cpu::SceneView& scene, cpu::TraceContext& context,
                                   const cpu::TraceRay& world, uint32_t patch, RayState& ray) {
    const Surface& surface = scene.surfaces[scene.instances[ray.instance].surface];
    return surface.has_displacement ? trace_patch<kQuery>(scene, context, world, patch, ray)
                                    : trace_polygon<kQuery>(surface, patch, ray);
}

/// The subtree of `root` of one instance's surface. `ray` is in the object's space.
template <Query kQuery>
bool trace_instance(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                    uint32_t root, RayState& ray) {
    const uint32_t surface = scene.instances[ray.instance].surface;
    if (!scene.surfaces[surface].has_displacement)
        return trace_polygons<kQuery>(scene.polygon_trees[surface], root, ray);
    const WideBvh& tree = scene.surface_trees[surface];
    RayWalker walker{ray};
    return walk_primitives(
        tree, context, walker,
        {root, ray.t_min}, [&](uint32_t patch, const StackEntry&) __attribute__((always_inline)) {
            const bool has_hit = trace_patch<kQuery>(scene, context, world, patch, ray);
            return kQuery == Query::any && has_hit;
        });
}

/// Everything of one instance. `best` is in world space and carries t_max and the hit.
template <Query kQuery>
RELIEF_INLINE bool visit_instance(const cpu::SceneView& scene, cpu::TraceContext& context,
                                  const cpu::TraceRay& world, uint32_t instance, RayState& best) {
    if (!scene.is_visible(instance)) return false;
    const Instance& placed = scene.instances[instance];
    if (placed.is_in_place && !is_far_away(world.origin, placed)) {
        best.instance = instance;
        return trace_instance<kQuery>(scene, context, world, 0, best);
    }
    RayState ray = best;
    ray.instance = instance;
    enter_object(world, placed, ray);
    const bool is_hit = trace_instance<kQuery>(scene, context, world, 0, ray);
    take_over(best, ray);
    return is_hit;
}

/// The whole scene along one ray, from `root` of the instance tree. `best` carries t_max and the hit.
template <Query kQuery>
bool trace_scene(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                 uint32_t root, RayState& best) {
    RayWalker walker{best};
    return walk_primitives(*scene.instance_tree, context, walker, {root, best.t_min},
                           [&](uint32_t instance, const StackEntry&) {
                               return visit_instance<kQuery>(scene, context, world, instance, best);
                           });
}

/// The whole scene along one ray; `ray` begins empty. An only instance needs no tree over instances.
template <Query kQuery>
RELIEF_INLINE bool trace_ray(const cpu::SceneView& scene, cpu::TraceContext& context,
                             const cpu::TraceRay& world, RayState& ray) {
    ray.t_min = world.t_min, ray.t_max = world.t_max;
    if (scene.instance_count != 1) {
        enter_world(world, ray);
        return trace_scene<kQuery>(scene, context, world, 0, ray);
    }
    ray.instance = 0;
    enter_object(world, scene.instances[0], ray);
    return trace_instance<kQuery>(scene, context, world, 0, ray);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
