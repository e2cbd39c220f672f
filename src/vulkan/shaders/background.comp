// Emission of the environment and of the scene's lights hit by camera and bounce rays.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"
#include "vulkan/shaders/light_tree.glsl"
#include "vulkan/shaders/lights.glsl"
#include "vulkan/shaders/light_sums.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// Light that a bounce ray meets goes to the colour in a first pass; in a second one, of pictures with layers of groups
/// of lights, times a factor to those.
struct Meeting {
    uint path_index;
    vec3 factor;
    bool is_shared; ///< the second pass
};

vec3 share_out(Meeting meeting, LightSourceData source, vec3 light) {
    if (kLightGroups != 0u && meeting.is_shared)
        add_to_group(push.capacity, meeting.path_index, source.group, meeting.factor * light);
    return light;
}

/// Lights of the tree that a ray meets.
vec3 gather_in_tree(Meeting meeting, PathData path, LitPoint at, float tree_share, vec3 direction, float distance) {
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
        sum += share_out(meeting, source, seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share));
    }
    return sum;
}

/// Each light is MIS-weighted against next-event estimation at the previous vertex.
vec3 gather_light(Meeting meeting, PathData path, vec3 direction, float distance) {
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
        sum += share_out(meeting, source, seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share));
    }
    if (kHasLightTree != 0u) sum += gather_in_tree(meeting, path, at, 1.0 - list_share, direction, distance);
    return sum;
}

/// What a camera ray is to see of lights.
struct Sight {
    vec3 radiance;
    bool is_met; ///< though its texture may be black there
};

void add_sight(uint path_index, inout Sight sight, LightSourceData source, RayData ray, float distance) {
    vec3 seen = see_light(source, ray.origin, ray.direction, distance);
    if (seen == vec3(0.0)) return;
    sight.is_met = true;
    vec3 light = has_texture(source) ? seen * find_light_color(source, ray.origin, ray.direction) : seen;
    sight.radiance += light;
    add_to_group(push.capacity, path_index, source.group, light);
}

Sight see_lights(uint path_index, RayData ray, float distance) {
    Sight sight = {vec3(0.0), false};
    for (uint k = 0u; k < push.source_count; ++k)
        if (sources[k].is_visible != 0u) add_sight(path_index, sight, sources[k], ray, distance);
    if (kHasLightTree == 0u) return sight;
    uint end = light_nodes[push.first_light_node].end;
    for (uint k = push.first_light_node; k < end; ++k) {
        k = find_leaf(k, end, ray.origin, ray.direction, distance, kCanBeSeen);
        if (k == end) break;
        add_sight(path_index, sight, sources[light_nodes[k].source], ray, distance);
    }
    return sight;
}

void see_background(uint path_index, vec3 light, uint group) {
    paths[path_index].radiance += light;
    add_to_kind(push.capacity, path_index, kKindBackground, light);
    add_to_group(push.capacity, path_index, group, light);
}

void meet_lights(uint path_index, vec3 direction, float distance) {
    PathData path = paths[path_index];
    uint bounces = push.depth - 1u;
    Meeting meeting = {path_index, vec3(0.0), false};
    // A loop, so that the lights are inlined only once.
    for (uint pass = 0u; pass < (kLightGroups != 0u ? 2u : 1u); ++pass) {
        vec3 light = path.throughput * gather_light(meeting, path, direction, distance);
        if (pass > 0u) break;
        vec3 found = clamp_indirect(light, push.clamp_indirect, bounces);
        paths[path_index].radiance = path.radiance + found;
        add_scattered(push.capacity, path_index, found, bounces);
        meeting.factor = path.throughput * find_clamp_scale(light, push.clamp_indirect, bounces);
        meeting.is_shared = true;
    }
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    vec3 direction = rays[path_index].direction;
    float distance = is_hit(hit) ? hit.t : make_infinity();
    if (push.depth > 0u) {
        meet_lights(path_index, direction, distance);
        return;
    }
    Sight seen = see_lights(path_index, rays[path_index], distance);
    paths[path_index].radiance += seen.radiance;
    add_to_kind(push.capacity, path_index, kKindEmission, seen.radiance);
    if (!is_hit(hit)) {
        // Lights cover the background of the picture, which is none of the scene.
        if (seen.is_met) film[path_index].light_count += 1.0;
        if (seen.is_met && push.has_background != 0u) return;
        if (push.has_background != 0u)
            see_background(path_index, push.background, kDefaultGroup);
        else if (push.has_environment != 0u)
            see_background(path_index, environment_radiance(push.environment, direction), kEnvironmentGroup);
    }
}
