// Interpolated normals of patches: compute_shading_normal of surface/patch/shading_normal.cpp. Attributes of vertices are
// read where they are needed, frames last.
#ifndef RELIEF_SHADING_NORMAL_GLSL
#define RELIEF_SHADING_NORMAL_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"
#include "formulas/warp.h"
#include "formulas/shading_normal.h"

vec3 blend_normals(const SurfaceData s, const uvec4 quad, const vec2 at) {
    return interpolate_quad(load_normal(s, quad.x), load_normal(s, quad.y), load_normal(s, quad.z),
                            load_normal(s, quad.w), at);
}

/// Normal of an undisplaced patch.
vec3 compute_plain_normal(const SurfaceData s, const uvec4 quad, const vec2 at) {
    bool is_polygon = is_triangle(quad);
    vec3 blended = is_polygon ? interpolate_triangle(load_normal(s, quad.x), load_normal(s, quad.y),
                                                     load_normal(s, quad.z), at)
                              : blend_normals(s, quad, at);
    bool is_upper = at.y > at.x && !is_polygon;
    vec3 origin = load_position(s, quad.x);
    vec3 first = load_position(s, is_upper ? quad.z : quad.y) - origin;
    vec3 second = load_position(s, is_upper ? quad.w : quad.z) - origin;
    return make_plain_normal(blended, cross_exact(first, second));
}

vec2 find_ends(const SurfaceData s, const uint patch_index, const uint level, const float at, const uvec2 edges) {
    return find_difference_ends(at, 0.5 / float(1u << level), is_seam(s, patch_index, edges.x), is_seam(s, patch_index, edges.y));
}

/// Derivatives of a patch's base along u and along v.
struct BaseDerivatives {
    vec3 u, v;
};

BaseDerivatives differentiate_position(const SurfaceData s, const uvec4 quad, const uint patch_index, const vec2 at) {
    if (is_bicubic(s))
        return BaseDerivatives(differentiate_base(s, quad, patch_index, at, 0u),
                               differentiate_base(s, quad, patch_index, at, 1u));
    vec3 corner[4] = {load_position(s, quad.x), load_position(s, quad.y), load_position(s, quad.z),
                      load_position(s, quad.w)};
    return BaseDerivatives(blend_difference(corner[0], corner[1], corner[3], corner[2], at.y),
                           blend_difference(corner[0], corner[3], corner[1], corner[2], at.x));
}

/// Displacement at a place and its derivatives there.
struct DisplacementSlopes {
    vec3 d, u, v;
};

DisplacementSlopes differentiate_displacement(const SurfaceData s, const uvec4 quad, const uint patch_index,
                                              const uint level, const vec2 at) {
    uint mips = load_mips(s, patch_index);
    uint tile = load_vertex_tile(s, quad.x);
    uint normal_level = choose_normal_level(mips, level);
    vec2 ends_u = find_ends(s, patch_index, normal_level, at.x, uvec2(3u, 1u));
    vec2 ends_v = find_ends(s, patch_index, normal_level, at.y, uvec2(0u, 2u));
    vec2 c0 = vec2(0.0), c1 = vec2(0.0), c2 = vec2(0.0), c3 = vec2(0.0);
    if (s.first_uv != kNone)
        c0 = load_uv(s, quad.x), c1 = load_uv(s, quad.y), c2 = load_uv(s, quad.z), c3 = load_uv(s, quad.w);
    DisplacementSlopes result = {vec3(0.0), vec3(0.0), vec3(0.0)};
    // The place itself, then both ends of either difference. A loop, so that the look-up is inlined only once.
    for (uint k = 0u; k < 5u; ++k) {
        float x = k == 1u ? ends_u.x : k == 2u ? ends_u.y : at.x;
        float y = k == 3u ? ends_v.x : k == 4u ? ends_v.y : at.y;
        vec2 uv = vec2(blend_quad(c0.x, c1.x, c2.x, c3.x, x, y), blend_quad(c0.y, c1.y, c2.y, c3.y, x, y));
        vec3 d = fetch_displacement(maps[s.map], tile, choose_normal_mip(mips), uv);
        if (k == 0u) result.d = d;
        if (k == 1u) result.u = d;
        if (k == 2u) result.u = (d - result.u) / (ends_u.y - ends_u.x);
        if (k == 3u) result.v = d;
        if (k == 4u) result.v = (d - result.v) / (ends_v.y - ends_v.x);
    }
    return result;
}

Basis differentiate_frame(const TangentFrame a, const TangentFrame b, const TangentFrame c, const TangentFrame d,
                          const float s) {
    return Basis(blend_difference(a.t, b.t, c.t, d.t, s), blend_difference(a.b, b.b, c.b, d.b, s),
                 blend_difference(a.n, b.n, c.n, d.n, s));
}

vec3 make_tangent_normal(const SurfaceData s, const uvec4 quad, const vec2 at, const BaseDerivatives base,
                         const DisplacementSlopes slopes, const vec3 normal) {
    TangentFrame c0 = load_frame(s, quad.x);
    TangentFrame c1 = load_frame(s, quad.y);
    TangentFrame c2 = load_frame(s, quad.z);
    TangentFrame c3 = load_frame(s, quad.w);
    Basis middle = {blend_quad_vectors(c0.t, c1.t, c2.t, c3.t, at.x, at.y),
                    blend_quad_vectors(c0.b, c1.b, c2.b, c3.b, at.x, at.y),
                    blend_quad_vectors(c0.n, c1.n, c2.n, c3.n, at.x, at.y)};
    SurfaceDerivative along_u = {base.u, differentiate_frame(c0, c1, c3, c2, at.y), slopes.u};
    SurfaceDerivative along_v = {base.v, differentiate_frame(c0, c3, c1, c2, at.x), slopes.v};
    return make_displaced_normal(displace_derivative_through(along_u, middle, slopes.d, normal),
                                 displace_derivative_through(along_v, middle, slopes.d, normal), normal);
}

vec3 compute_displaced_normal(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint level,
                              const vec2 at) {
    BaseDerivatives base = differentiate_position(s, quad, patch_index, at);
    vec3 normal = make_unit(blend_normals(s, quad, at));
    if (normal == vec3(0.0)) normal = make_unit(cross_exact(base.u, base.v));
    DisplacementSlopes slopes = differentiate_displacement(s, quad, patch_index, level, at);
    if (maps[s.map].is_tangent != 0u) return make_tangent_normal(s, quad, at, base, slopes, normal);
    Basis none = {vec3(0.0), vec3(0.0), vec3(0.0)};
    SurfaceDerivative along_u = {base.u, none, slopes.u};
    SurfaceDerivative along_v = {base.v, none, slopes.v};
    return make_displaced_normal(displace_derivative(along_u, normal), displace_derivative(along_v, normal), normal);
}

/// Object space, not oriented; zero on a surface without normals.
vec3 compute_shading_normal(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint level,
                            const vec2 at) {
    if (s.first_frame == kNone) return vec3(0.0);
    if (s.map == kNone) return compute_plain_normal(s, quad, at);
    return compute_displaced_normal(s, quad, patch_index, level, at);
}

#endif
