// The way up from triangles is traced: shadow rays go on from there to the light, and bring nothing where something was in
// that way.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint ray_index = path_list[index];
    uint path_index = ray_index - push.capacity;
    if (is_hit(hits[ray_index])) paths[path_index].contribution = vec3(0.0);
    RayData ray = rays[ray_index];
    ray.origin += ray.direction * ray.t_max;
    ray.direction = paths[path_index].lifted_direction;
    ray.t_max = paths[path_index].lifted_distance;
    rays[ray_index] = ray;
}
