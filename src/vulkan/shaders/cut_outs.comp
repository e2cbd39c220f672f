// Lists the rays that pass the cut-out which they have met; they go on from behind it.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/surface_point.glsl"
#include "vulkan/shaders/textures.glsl"
#include "vulkan/shaders/texture_place.glsl"
#include "vulkan/shaders/input_look_up.glsl"

layout(scalar, push_constant) uniform Push { CutOutPush push; };

#include "vulkan/shaders/met_lights.glsl"

/// Opacity, and metallic where clear walls ask for it; of these their textures change the glass as well.
vec2 find_wall_numbers(const HitData hit, const bool is_wall, inout MaterialData material) {
    vec2 found = vec2(material.opacity, material.metallic);
    if (material.inputs == kNone) return found;
    MaterialInputData inputs = material_inputs[material.inputs];
    uint places = is_wall ? kWallPlaces : kOpacityPlace;
    if ((inputs.places & places) == 0u) return found;
    InputNumbers numbers =
        find_inputs_at(inputs, places, instances[hit.instance], hit.patch_index, vec2(hit.u, hit.v));
    if (kHasVertexNumbers != 0u && is_wall && material.has_vertex_numbers != 0u)
        material.glass = set_glass_inputs(material.glass, numbers, inputs.constants);
    return vec2(numbers.word[kInputOpacity], numbers.word[kInputMetallic]);
}

/// Cosine of a ray to the geometric normal.
float find_cosine(const uint ray_index, const HitData hit) {
    CellPoint found = evaluate_hit(hit);
    return abs(dot(found.triangle.normal, rays[ray_index].direction));
}

/// The path goes on with `left` of its light. Lights that it has met before the wall shine through none.
void pass_wall(const uint path_index, const float distance, const vec3 left) {
    vec3 lost = paths[path_index].throughput * (vec3(1.0) - left);
    paths[path_index].throughput *= left;
    if (lost == vec3(0.0)) return;
    LightSeen nothing = {vec3(0.0), 0.0, distance};
    if (push.depth > 0u)
        meet_lights(path_index, lost, distance, nothing);
    else
        see_lights(path_index, lost, distance);
}

/// Of the ray of a path, or of its shadow ray, which loses part of its light in place of being drawn for.
bool passes(const uint path_index, const uint ray_index, const HitData hit) {
    if (!is_hit(hit)) return false;
    MaterialData material = materials[instances[hit.instance].material];
    bool is_wall = kHasGlass != 0u && material.has_glass != 0u && material.glass.kind == kClearWall;
    vec2 found = find_wall_numbers(hit, is_wall, material);
    float u = draw_cut_out(paths[path_index].pixel_seed, push.sample_index, push.depth, push.is_shadow, push.round);
    if (!is_wall) return u >= found.x;
    vec3 left = pass_clear_wall(material.glass, found.y, found.x, find_cosine(ray_index, hit));
    float share = largest_component(left);
    if (push.is_shadow != 0u) {
        paths[path_index].contribution *= left;
        return share > 0.0;
    }
    if (u < 1.0 - share) return false;
    pass_wall(path_index, hit.t, left * (1.0 / share));
    return true;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    bool is_shadow = push.is_shadow != 0u;
    uint ray_index = is_shadow ? shadow_list[index] : path_list[index];
    HitData hit = hits[ray_index];
    uint count = passes(is_shadow ? ray_index - push.capacity : ray_index, ray_index, hit) ? 1u : 0u;
    uint place = atomicAdd(counters.path_count, count);
    if (count == 0u) return;
    rays[ray_index].t_min = hit.t;
    if (is_shadow)
        path_list[place] = ray_index;
    else
        next_path_list[place] = ray_index;
}
