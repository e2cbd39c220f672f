// Far parts, on a coarser surface, of the bounce rays that met nothing in their near parts.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    RayData ray = rays[path_index];
    uint count = !is_hit(hits[path_index]) && ray.t_max < make_infinity() ? 1u : 0u;
    uint place = atomicAdd(counters.shadow_count, count);
    if (count == 0u) return;
    ray.t_min = ray.t_max;
    ray.t_max = make_infinity();
    ray.lod_bias = kBounceBias;
    rays[path_index] = ray;
    shadow_list[place] = path_index;
}
