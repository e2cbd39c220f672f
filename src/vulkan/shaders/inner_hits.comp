// Far parts of bounce rays that met the coarse surface from within go on along the fine one.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/surface_point.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

bool is_inner(const uint path_index, const HitData hit) {
    CellPoint found = evaluate_hit(hit);
    return dot(found.triangle.normal, rays[path_index].direction) > 0.0;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = shadow_list[index];
    HitData hit = hits[path_index];
    uint count = is_hit(hit) && is_inner(path_index, hit) ? 1u : 0u;
    uint place = atomicAdd(counters.path_count, count);
    if (count == 0u) return;
    rays[path_index].lod_bias = 0u;
    next_path_list[place] = path_index;
}
