// Emission of the environment and of the scene's lights hit by camera and bounce rays.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"
#include "vulkan/shaders/light_tree.glsl"
#include "vulkan/shaders/lights.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// Lights of the tree that a ray meets.
vec3 gather_in_tree(PathData path, LitPoint at, float tree_share, vec3 direction, float distance) {
    vec3 sum = vec3(0.0);
    uint root = push.first_light_node;
    uint end = light_nodes[root].end;
    for (uint k = root; k < end; ++k) {
        k = find_leaf(k, end, at.position, direction, distance, kCanBeMet);
        if (k == end) break;
        LightSourceData source = sources[light_nodes[k].source];
        if (!is_lit(source, at)) continue;
        LightSeen seen = meet_source(source, at.position, direction, distance);
        if (seen.radiance == vec3(0.0)) continue;
        float share = tree_share * find_in_tree(root, at, k);
        sum += seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share);
    }
    return sum;
}

/// Each light is MIS-weighted against next-event estimation at the previous vertex.
vec3 gather_light(PathData path, vec3 direction, float distance) {
    vec3 sum = vec3(0.0);
    LitPoint at = {path.previous, path.normal, path.instance};
    float total = total_irradiance(push.source_count, at);
    float list_share = 1.0 - find_share_of_tree(push.first_light_node, at, total);
    for (uint k = 0u; k < push.source_count; ++k) {
        LightSourceData source = sources[k];
        if (!is_lit(source, at)) continue;
        LightSeen seen = meet_source(source, path.previous, direction, distance);
        if (source.kind == kSourceEnvironment && distance == make_infinity()) {
            seen.radiance = environment_radiance(push.environment, direction);
            seen.pdf = environment_pdf(push.environment, direction);
        }
        if (seen.radiance == vec3(0.0)) continue;
        float share = total > 0.0 ? estimate_irradiance(source, path.previous) / total * list_share : 0.0;
        sum += seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share);
    }
    if (kHasLightTree != 0u) sum += gather_in_tree(path, at, 1.0 - list_share, direction, distance);
    return sum;
}

/// What a camera ray is to see of lights.
struct Sight {
    vec3 radiance;
    bool is_met; ///< though its texture may be black there
};

void add_sight(inout Sight sight, LightSourceData source, RayData ray, float distance) {
    vec3 seen = see_light(source, ray.origin, ray.direction, distance);
    if (seen == vec3(0.0)) return;
    sight.is_met = true;
    sight.radiance += has_texture(source) ? seen * find_light_color(source, ray.origin, ray.direction) : seen;
}

Sight see_lights(RayData ray, float distance) {
    Sight sight = {vec3(0.0), false};
    for (uint k = 0u; k < push.source_count; ++k)
        if (sources[k].is_visible != 0u) add_sight(sight, sources[k], ray, distance);
    if (kHasLightTree == 0u) return sight;
    uint end = light_nodes[push.first_light_node].end;
    for (uint k = push.first_light_node; k < end; ++k) {
        k = find_leaf(k, end, ray.origin, ray.direction, distance, kCanBeSeen);
        if (k == end) break;
        add_sight(sight, sources[light_nodes[k].source], ray, distance);
    }
    return sight;
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
    Sight seen = see_lights(rays[path_index], distance);
    paths[path_index].radiance += seen.radiance;
    if (!is_hit(hit)) {
        // Lights cover the background of the picture, which is none of the scene.
        if (seen.is_met) film[path_index].light_count += 1.0;
        if (seen.is_met && push.has_background != 0u) return;
        if (push.has_background != 0u)
            paths[path_index].radiance += push.background;
        else if (push.has_environment != 0u)
            paths[path_index].radiance += environment_radiance(push.environment, direction);
    }
}
