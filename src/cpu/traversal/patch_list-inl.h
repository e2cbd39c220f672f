// Which displaced patches a ray may meet, in place of what it meets in them.
#pragma once

#include "cpu/traversal/scene_traversal-inl.h"
#include "engine/finite_ray.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Appends the patches of one instance whose boxes the ray enters; polygons are met at once.
inline void list_instance(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                          uint32_t ray_index, RayState& ray, std::vector<cpu::PatchEntry>& entries) {
    const uint32_t surface = scene.instances[ray.instance].surface;
    if (!scene.surfaces[surface].has_displacement) {
        trace_instance<Query::closest>(scene, context, world, 0, ray);
        return;
    }
    RayWalker walker{ray};
    walk_primitives(scene.surface_trees[surface], context, walker, {0, ray.t_min},
                    [&](uint32_t patch, const StackEntry& leaf) {
                        entries.push_back({leaf.entry + ray.shift, ray_index, ray.instance, patch});
                        return false;
                    });
}

/// The whole scene along ray `ray_index` of a batch. `hit` becomes the nearest hit of a polygon.
inline void list_patches(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                         uint32_t ray_index, cpu::TraceHit& hit, std::vector<cpu::PatchEntry>& entries) {
    hit = {};
    if (!relief::can_hit(world)) return;
    RayState best;
    best.t_min = world.t_min, best.t_max = world.t_max;
    enter_world(world, best);
    RayWalker walker{best};
    walk_primitives(*scene.instance_tree, context, walker, {0, best.t_min},
                    [&](uint32_t instance, const StackEntry&) {
                        if (!scene.is_visible(instance)) return false;
                        RayState ray = best;
                        ray.instance = instance;
                        enter_object(world, scene.instances[instance], ray);
                        list_instance(scene, context, world, ray_index, ray, entries);
                        take_over(best, ray);
                        return false;
                    });
    hit = best.hit;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
