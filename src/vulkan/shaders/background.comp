// Emission of the environment and of the scene's lights hit by camera and bounce rays.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"
#include "vulkan/shaders/lights.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// Each light is MIS-weighted against next-event estimation at the previous vertex.
vec3 gather_light(PathData path, vec3 direction, float distance) {
    vec3 sum = vec3(0.0);
    float total = total_irradiance(push.source_count, path.previous);
    for (uint k = 0u; k < push.source_count; ++k) {
        LightSourceData source = sources[k];
        LightSeen seen = meet_light(source, path.previous, direction, distance);
        if (source.kind == kSourceEnvironment && distance == make_infinity()) {
            seen.radiance = environment_radiance(push.environment, direction);
            seen.pdf = environment_pdf(push.environment, direction);
        }
        if (seen.radiance == vec3(0.0)) continue;
        float share = total > 0.0 ? estimate_irradiance(source, path.previous) / total : 0.0;
        sum += seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share);
    }
    return sum;
}

/// The lights that a camera ray is to see.
vec3 see_lights(RayData ray, float distance) {
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < push.source_count; ++k)
        if (sources[k].is_visible != 0u) sum += see_light(sources[k], ray.origin, ray.direction, distance);
    return sum;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    vec3 direction = rays[path_index].direction;
    float distance = is_hit(hit) ? hit.t : make_infinity();
    if (push.depth > 0u) {
        PathData path = paths[path_index];
        vec3 light = path.throughput * gather_light(path, direction, distance);
        paths[path_index].radiance = path.radiance + clamp_indirect(light, push.clamp_indirect, push.depth - 1u);
        return;
    }
    paths[path_index].radiance += see_lights(rays[path_index], distance);
    if (!is_hit(hit)) {
        if (push.has_background != 0u)
            paths[path_index].radiance += push.background;
        else if (push.has_environment != 0u)
            paths[path_index].radiance += environment_radiance(push.environment, direction);
    }
}
