// Emission of the environment and of the scene's lights hit by camera and bounce rays.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

#include "vulkan/shaders/met_lights.glsl"
#include "formulas/guides.h"

void see_background(const uint path_index, const vec3 light, const uint group) {
    paths[path_index].radiance += light;
    add_to_kind(push.capacity, path_index, kKindBackground, light);
    add_to_group(push.capacity, path_index, group, light);
}

/// The environment along a bounce ray that leaves the scene.
LightSeen look_behind(const vec3 direction, const float distance) {
    LightSeen behind = {vec3(0.0), 0.0, distance};
    if (distance < make_infinity() || push.has_environment == 0u) return behind;
    behind.radiance = environment_radiance(push.environment, direction);
    behind.pdf = environment_pdf(push.environment, direction);
    return behind;
}

/// What is behind all surfaces has its colour for an albedo; seen in a mirror it faces the path.
void note_sky(const uint path_index, const vec3 direction, const vec3 light) {
    if (!looks_for_guides(push.capacity, path_index, push.depth)) return;
    add_guides(push.capacity, path_index, find_guide_albedo(paths[path_index].throughput, light),
               push.depth > 0u ? -direction : vec3(0.0));
}

/// That a camera ray sees.
vec3 find_background(const vec3 direction) {
    if (push.has_background != 0u) return push.background;
    return push.has_environment != 0u ? environment_radiance(push.environment, direction) : vec3(0.0);
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    vec3 direction = rays[path_index].direction;
    float distance = is_hit(hit) ? hit.t : make_infinity();
    if (push.depth > 0u) {
        LightSeen behind = look_behind(direction, distance);
        if (!is_hit(hit)) note_sky(path_index, direction, behind.radiance);
        meet_lights(path_index, paths[path_index].throughput, distance, behind);
        return;
    }
    // Less than 1 of rays that came through clear walls.
    vec3 share = kHasGlass != 0u ? paths[path_index].throughput : vec3(1.0);
    bool is_met = see_lights(path_index, share, distance);
    // They hide the shadows behind them, as they hide the background.
    bool is_covered = is_met && is_hit(hit) && is_catcher(hit, push.depth);
    if (is_covered) hits[path_index].instance = kNone;
    if (is_hit(hit) && !is_covered) return;
    vec3 seen = find_background(direction);
    note_sky(path_index, direction, seen);
    // Lights cover the background of the picture, which is none of the scene.
    if (is_met) film[path_index].light_count += 1.0;
    if (is_met && push.has_background != 0u) return;
    if (push.has_background != 0u)
        see_background(path_index, share * seen, kDefaultGroup);
    else if (push.has_environment != 0u)
        see_background(path_index, share * seen, kEnvironmentGroup);
}
