// Lists the rays that pass the cut-out which they have met; they go on from behind it.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/textures.glsl"
#include "vulkan/shaders/texture_place.glsl"

layout(scalar, push_constant) uniform Push { CutOutPush push; };

float find_opacity(HitData hit) {
    InstanceData instance = instances[hit.instance];
    MaterialData material = materials[instance.material];
    if (material.opacity_texture == kNone) return material.opacity;
    SurfaceData s = surfaces[instance.surface];
    vec2 uv = interpolate_uv(s, load_corners(s, hit.patch_index), vec2(hit.u, hit.v));
    return clamp(material.opacity * fetch_texture(material.opacity_texture, uv).x, 0.0, 1.0);
}

bool passes(uint path_index, HitData hit) {
    if (!is_hit(hit)) return false;
    float u = draw_cut_out(paths[path_index].pixel_seed, push.sample_index, push.depth, push.is_shadow, push.round);
    return u >= find_opacity(hit);
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    bool is_shadow = push.is_shadow != 0u;
    uint ray_index = is_shadow ? shadow_list[index] : path_list[index];
    HitData hit = hits[ray_index];
    uint count = passes(is_shadow ? ray_index - push.capacity : ray_index, hit) ? 1u : 0u;
    uint place = atomicAdd(counters.path_count, count);
    if (count == 0u) return;
    rays[ray_index].t_min = hit.t;
    if (is_shadow)
        path_list[place] = ray_index;
    else
        next_path_list[place] = ray_index;
}
