// Lists the shadow rays that start above their triangles; so far they are the way up there.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint ray_index = shadow_list[index];
    uint count = paths[ray_index - push.capacity].lifted_distance > 0.0 ? 1u : 0u;
    uint place = atomicAdd(counters.path_count, count);
    if (count > 0u) path_list[place] = ray_index;
}
