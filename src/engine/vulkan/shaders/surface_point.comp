// Makes hits ready for shading: position, normals, material with its textures. First hits go into the layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/vulkan/shaders/kernel.glsl"
#include "engine/vulkan/shaders/paths.glsl"
#include "engine/vulkan/shaders/textures.glsl"
#include "engine/vulkan/shaders/surface_point.glsl"
#include "engine/vulkan/shaders/shading_normal.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// What only this kernel knows of a point.
struct Appearance {
    vec3 shading_normal; ///< on the viewer's side
    vec2 uv;
};

vec2 interpolate_uv(SurfaceData s, PatchCorners c, vec2 at) {
    if (s.first_uv == kNone) return vec2(0.0);
    return s.map != kNone ? blend_patch_uv(c.corner[0].uv, c.corner[1].uv, c.corner[2].uv, c.corner[3].uv, at)
                          : blend_polygon_uv(c.corner[0].uv, c.corner[1].uv, c.corner[2].uv, c.corner[3].uv, at);
}

void apply_material(MaterialData material, vec2 uv, inout SurfacePointData point) {
    point.base_color = material.base_color;
    point.roughness = material.roughness;
    if (material.color_texture != kNone) point.base_color *= fetch_texture(material.color_texture, uv);
    if (material.roughness_texture != kNone) point.roughness *= fetch_texture(material.roughness_texture, uv).x;
    point.base_color = limit_color(point.base_color);
    point.roughness = clamp(point.roughness, 0.0, 1.0);
}

Appearance make_point(HitData hit, vec3 wo, out SurfacePointData point) {
    InstanceData instance = instances[hit.instance];
    SurfaceData s = surfaces[instance.surface];
    PatchCorners corners = load_corners(s, hit.patch_index);
    CellPlace place = {hit.u, hit.v, cell_column(hit.cell), cell_row(hit.cell), cell_is_upper(hit.cell) != 0u};
    FacetPoint found = evaluate_facet(instance, corners, hit.patch_index, hit.levels, place);
    vec2 at = vec2(hit.u, hit.v);
    vec3 smooth_normal = compute_shading_normal(s, corners, hit.patch_index, packed_patch_level(hit.levels), at);
    vec3 shading_normal =
        orient_shading_normal(transform_normal(instance.object_from_world, smooth_normal), found.facet.normal);
    Appearance appearance;
    appearance.uv = interpolate_uv(s, corners, at);
    bool is_flipped = dot(found.facet.normal, wo) < 0.0;
    appearance.shading_normal = is_flipped ? -shading_normal : shading_normal;
    point.position = found.facet.position;
    point.position_error = found.position_error;
    point.geometric_normal = is_flipped ? -found.facet.normal : found.facet.normal;
    point.area_per_uv = found.facet.area_per_uv;
    point.bent_normal = bend_normal(appearance.shading_normal, point.geometric_normal, wo);
    point.is_flipped = is_flipped ? 1u : 0u;
    apply_material(materials[instance.material], appearance.uv, point);
    return appearance;
}

void record_first_hit(uint pixel, HitData hit, SurfacePointData point, Appearance appearance) {
    FilmSumsData sums = film[pixel];
    sums.hit_count += 1.0;
    sums.shading_normal += appearance.shading_normal;
    sums.geometric_normal += point.geometric_normal;
    sums.position += point.position;
    sums.albedo += point.base_color;
    sums.uv += appearance.uv;
    uint id = hit.instance + 1u;
    if (sums.id == 0u || hit.t < sums.depth || (hit.t == sums.depth && id < sums.id)) {
        sums.depth = hit.t;
        sums.id = id;
    }
    film[pixel] = sums;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    if (!is_hit(hit)) return;
    SurfacePointData point;
    Appearance appearance = make_point(hit, -rays[path_index].direction, point);
    points[path_index] = point;
    if (push.depth == 0u) record_first_hit(path_index, hit, point, appearance);
}
