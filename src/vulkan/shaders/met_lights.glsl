// Lights that rays of paths meet by themselves. Behind a push constant block `push` with capacity, depth, source_count,
// first_light_node and clamp_indirect.
#ifndef RELIEF_MET_LIGHTS_GLSL
#define RELIEF_MET_LIGHTS_GLSL

#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/lights.glsl"
#include "vulkan/shaders/light_sums.glsl"

/// Light that a bounce ray meets goes to the colour in a first pass; in a second one, of pictures with layers of groups
/// of lights, times a factor to those.
struct Meeting {
    uint path_index;
    vec3 factor;
    bool is_shared; ///< the second pass
};

/// MIS-weighted against next-event estimation at the previous vertex, which draws the light with `share`; less of it
/// comes through the body that the path is in.
vec3 weigh_light(const Meeting meeting, const PathData path, const LightSourceData source, const LightSeen seen,
                 const float share) {
    vec3 light = seen.radiance * power_heuristic(path.bsdf_pdf, seen.pdf * share);
    if (kHasGlass != 0u && path.body != kNone) light *= absorb_along(materials[path.body].glass.depth, seen.distance);
    if (kLightGroups != 0u && meeting.is_shared)
        add_to_group(push.capacity, meeting.path_index, source.group, meeting.factor * light);
    return light;
}

/// Lights of the tree.
vec3 gather_in_tree(const Meeting meeting, const PathData path, const LitPoint at, const float tree_share,
                    const vec3 direction, const float distance) {
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
        sum += weigh_light(meeting, path, source, seen, tree_share * find_in_tree(root, at, k));
    }
    return sum;
}

/// `behind`: the environment along a ray of infinite distance.
vec3 gather_light(const Meeting meeting, const PathData path, const vec3 direction, const float distance,
                  const LightSeen behind) {
    vec3 sum = vec3(0.0);
    LitPoint at = {path.previous, path.normal, path.instance};
    float total = estimate_listed(push.source_count, at);
    float list_share = find_list_share(push.first_light_node, at, total);
    for (uint k = 0u; k < push.source_count; ++k) {
        LightSourceData source = sources[k];
        if (!is_lit(source, at)) continue;
        LightSeen seen = meet_source(source, path.previous, direction, distance);
        if (source.kind == kSourceEnvironment && distance == make_infinity()) seen = behind;
        if (seen.radiance == vec3(0.0)) continue;
        float share = total > 0.0 ? estimate_irradiance(source, path.previous) / total * list_share : 0.0;
        sum += weigh_light(meeting, path, source, seen, share);
    }
    if (kHasLightTree != 0u) sum += gather_in_tree(meeting, path, at, 1.0 - list_share, direction, distance);
    return sum;
}

/// Adds what a bounce ray meets before `distance`, of which `share` comes to the camera.
void meet_lights(const uint path_index, const vec3 share, const float distance, const LightSeen behind) {
    PathData path = paths[path_index];
    vec3 direction = rays[path_index].direction;
    uint bounces = push.depth - 1u;
    Meeting meeting = {path_index, vec3(0.0), false};
    // A loop, so that the lights are inlined only once.
    for (uint pass = 0u; pass < (kLightGroups != 0u ? 2u : 1u); ++pass) {
        vec3 light = share * gather_light(meeting, path, direction, distance, behind);
        if (pass > 0u) break;
        vec3 found = clamp_indirect(light, push.clamp_indirect, bounces);
        paths[path_index].radiance = path.radiance + found;
        add_scattered(push.capacity, path_index, found, bounces);
        meeting.factor = share * find_clamp_scale(light, push.clamp_indirect, bounces);
        meeting.is_shared = true;
    }
}

/// True if the light is met, though its texture may be black there.
bool add_sight(const uint path_index, const vec3 share, const LightSourceData source, const float distance) {
    RayData ray = rays[path_index];
    vec3 seen = see_light(source, ray.origin, ray.direction, distance);
    if (seen == vec3(0.0)) return false;
    vec3 light = has_texture(source) ? seen * find_light_color(source, ray.origin, ray.direction) : seen;
    light *= share;
    paths[path_index].radiance += light;
    add_to_kind(push.capacity, path_index, kKindEmission, light);
    add_to_group(push.capacity, path_index, source.group, light);
    return true;
}

/// Adds the lights that a camera ray is to see before `distance`; true if it meets one.
bool see_lights(const uint path_index, const vec3 share, const float distance) {
    bool is_met = false;
    for (uint k = 0u; k < push.source_count; ++k)
        if (sources[k].is_visible != 0u && add_sight(path_index, share, sources[k], distance)) is_met = true;
    if (kHasLightTree == 0u) return is_met;
    RayData ray = rays[path_index];
    uint end = light_nodes[push.first_light_node].end;
    for (uint k = push.first_light_node; k < end; ++k) {
        k = find_leaf(k, end, ray.origin, ray.direction, distance, kCanBeSeen);
        if (k == end) break;
        if (add_sight(path_index, share, sources[light_nodes[k].source], distance)) is_met = true;
    }
    return is_met;
}

#endif
