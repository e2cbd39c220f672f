// Interpolated normals of patches: compute_shading_normal of surface/patch/shading_normal.cpp.
#ifndef RELIEF_SHADING_NORMAL_GLSL
#define RELIEF_SHADING_NORMAL_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"
#include "formulas/warp.h"
#include "formulas/shading_normal.h"

vec3 blend_normals(SurfaceData s, uvec4 quad, vec2 at) {
    return interpolate_quad(load_normal(s, quad.x), load_normal(s, quad.y), load_normal(s, quad.z),
                            load_normal(s, quad.w), at);
}

/// Normal of an undisplaced patch.
vec3 compute_plain_normal(SurfaceData s, PatchCorners c, vec2 at) {
    bool is_polygon = is_triangle(c.quad);
    vec3 blended = is_polygon ? interpolate_triangle(load_normal(s, c.quad.x), load_normal(s, c.quad.y),
                                                     load_normal(s, c.quad.z), at)
                              : blend_normals(s, c.quad, at);
    bool is_upper = at.y > at.x && !is_polygon;
    vec3 first = c.corner[is_upper ? 2u : 1u].position - c.corner[0].position;
    vec3 second = c.corner[is_upper ? 3u : 2u].position - c.corner[0].position;
    return make_plain_normal(blended, cross_exact(first, second));
}

SurfaceDerivative differentiate(VertexData a, VertexData b, VertexData c, VertexData d, float s) {
    SurfaceDerivative result;
    result.base = blend_difference(a.position, b.position, c.position, d.position, s);
    result.frame.t = blend_difference(a.t, b.t, c.t, d.t, s);
    result.frame.b = blend_difference(a.b, b.b, c.b, d.b, s);
    result.frame.n = blend_difference(a.n, b.n, c.n, d.n, s);
    result.displacement = vec3(0.0);
    return result;
}

vec2 find_ends(SurfaceData s, uint patch_index, uint level, float at, uvec2 edges) {
    return find_difference_ends(at, 0.5 / float(1u << level), is_seam(s, patch_index, edges.x), is_seam(s, patch_index, edges.y));
}

vec3 compute_displaced_normal(SurfaceData s, PatchCorners c, uint patch_index, uint level, vec2 at) {
    SurfaceDerivative along_u = differentiate(c.corner[0], c.corner[1], c.corner[3], c.corner[2], at.y);
    SurfaceDerivative along_v = differentiate(c.corner[0], c.corner[3], c.corner[1], c.corner[2], at.x);
    if (is_bicubic(s)) {
        along_u.base = differentiate_base(s, c.quad, patch_index, at, 0u);
        along_v.base = differentiate_base(s, c.quad, patch_index, at, 1u);
    }
    vec3 normal = make_unit(blend_normals(s, c.quad, at));
    if (normal == vec3(0.0)) normal = make_unit(cross_exact(along_u.base, along_v.base));
    MapData map = maps[s.map];
    uint normal_level = choose_normal_level(c.mips, level);
    vec2 ends_u = find_ends(s, patch_index, normal_level, at.x, uvec2(3u, 1u));
    vec2 ends_v = find_ends(s, patch_index, normal_level, at.y, uvec2(0u, 2u));
    vec2 places[5] = {at, vec2(ends_u.x, at.y), vec2(ends_u.y, at.y), vec2(at.x, ends_v.x), vec2(at.x, ends_v.y)};
    vec3 displacements[5];
    for (uint k = 0u; k < 5u; ++k) {
        VertexData place = blend_corners(c.corner[0], c.corner[1], c.corner[2], c.corner[3], places[k].x, places[k].y);
        displacements[k] = fetch_displacement(map, place.tile, choose_normal_mip(c.mips), place.uv);
    }
    along_u.displacement = (displacements[2] - displacements[1]) / (ends_u.y - ends_u.x);
    along_v.displacement = (displacements[4] - displacements[3]) / (ends_v.y - ends_v.x);
    if (map.is_tangent == 0u)
        return make_displaced_normal(displace_derivative(along_u, normal), displace_derivative(along_v, normal),
                                     normal);
    VertexData middle = blend_corners(c.corner[0], c.corner[1], c.corner[2], c.corner[3], at.x, at.y);
    Basis frame = {middle.t, middle.b, middle.n};
    return make_displaced_normal(displace_derivative_through(along_u, frame, displacements[0], normal),
                                 displace_derivative_through(along_v, frame, displacements[0], normal), normal);
}

/// Object space, not oriented; zero on a surface without normals.
vec3 compute_shading_normal(SurfaceData s, PatchCorners c, uint patch_index, uint level, vec2 at) {
    if (s.first_frame == kNone) return vec3(0.0);
    if (s.map == kNone) return compute_plain_normal(s, c, at);
    return compute_displaced_normal(s, c, patch_index, level, at);
}

#endif
