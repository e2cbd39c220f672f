// Computes the patch (u, v) of a hit. Re-evaluates the micro-triangle, because its tree may have been overwritten.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/sample_evaluation.glsl"
#include "vulkan/shaders/rays.glsl"

layout(constant_id = 1) const uint kIsBoxLeaf = 0;

layout(scalar, push_constant) uniform Push { CastPush push; };

vec2 find_weights(const SurfaceData s, const HitData hit, const ObjectRay ray, const uvec2 cell, const uint is_upper) {
    vec3 p[3];
    for (uint k = 0u; k < 3u; ++k) {
        // Corners 00, 10, 11 of the lower triangle, 00, 11, 01 of the upper one.
        uvec2 corner = k == 0u ? uvec2(0u) : k == 1u ? uvec2(1u, is_upper) : uvec2(1u - is_upper, 1u);
        p[k] = shear_vertex(ray, find_sample(s, hit.patch_index, hit.levels, cell.x + corner.x, cell.y + corner.y));
    }
    TriangleHit found = intersect_sheared(ray, p[0], p[1], p[2], -kInfinity, kInfinity);
    return vec2(found.weight_b, found.weight_c);
}

void main() {
    uint place = invocation_index();
    if (place >= push.count) return;
    uint ray_index = active_rays[push.first + place];
    HitData hit = hits[ray_index];
    if (hit.instance == kNone) return;
    InstanceData instance = instances[hit.instance];
    SurfaceData s = surfaces[instance.surface];
    if (s.map == kNone) return; // already set for polygons
    uvec2 cell = uvec2(cell_column(hit.cell), cell_row(hit.cell));
    vec2 within = vec2(0.5);
    if (kIsBoxLeaf == 0u) {
        uint is_upper = cell_is_upper(hit.cell);
        vec2 weights = find_weights(s, hit, enter_object(rays[ray_index], instance), cell, is_upper);
        within = place_in_cell(weights, is_upper);
    }
    vec2 uv = place_on_patch(hit.cell, packed_patch_level(hit.levels), within);
    hits[ray_index].u = uv.x;
    hits[ray_index].v = uv.y;
}
