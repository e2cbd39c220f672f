// Adds the contribution of unoccluded shadow rays.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/light_sums.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint ray_index = shadow_list[index];
    uint path_index = ray_index - push.capacity;
    if (is_hit(hits[ray_index])) return;
    vec3 light = paths[path_index].contribution;
    if (is_catcher(hits[path_index], push.depth)) {
        film[path_index].shadow.y += luminance(light);
        return;
    }
    paths[path_index].radiance += light;
    add_shadow_light(push.capacity, path_index, light, push.depth);
}
