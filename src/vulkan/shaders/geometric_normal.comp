// Geometric normals of hits, oriented by the winding, for ray queries.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/surface_point.glsl"

layout(push_constant) uniform Push { uint ray_count; };

void main() {
    uint index = invocation_index();
    if (index >= ray_count) return;
    HitData hit = hits[index];
    if (!is_hit(hit)) return;
    CellPoint found = evaluate_hit(hit);
    points[index].geometric_normal = found.triangle.normal;
}
