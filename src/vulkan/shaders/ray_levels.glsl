// Levels at which a ray sees patches.
#ifndef RELIEF_RAY_LEVELS_GLSL
#define RELIEF_RAY_LEVELS_GLSL

#include "vulkan/shaders/rays.glsl"
#include "formulas/lod.h"

layout(scalar, push_constant) uniform Push { CastPush push; };
layout(constant_id = kRayLodConstant) const uint kHasRayLod = 0;

/// Packed levels of a patch of an instance for a ray.
uint choose_levels(const uint ray_index, const uint instance_index, const uint patch_index) {
    InstanceData instance = instances[instance_index];
    RayData world = rays[ray_index];
    uint levels = lower_packed_levels(find_levels(instance, patch_index), world.lod_bias);
    if (kHasRayLod == 0u || push.is_ray_lod == 0u) return levels;
    SurfaceData s = surfaces[instance.surface];
    uvec4 quad = load_quad(s, patch_index);
    float longest = 0.0;
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < 4u; ++k) {
        vec3 from = load_position(s, quad[k]);
        vec3 edge = load_position(s, quad[(k + 1u) & 3u]) - from;
        longest = max(longest, length(transform_vector(instance.world_from_object, edge)));
        sum += from;
    }
    vec3 middle = transform_point(instance.world_from_object, sum * 0.25);
    float distance_there = find_passing_distance(world.origin, world.direction, world.t_min, middle);
    return pack_uniform_level(choose_ray_level(longest, distance_there, push.pixel_angle, packed_patch_level(levels)));
}

#endif
