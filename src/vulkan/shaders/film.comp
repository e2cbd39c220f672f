// Adds the result of each path to the sums of its pixel.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    PathData path = paths[index];
    film[index].radiance += path.radiance;
    film[index].squares += path.radiance * path.radiance;
    film[index].cost += path.cost;
}
