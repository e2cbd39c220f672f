
#include "formulas/shading_normal.h"
#include "formulas/basis.h"
#include "formulas/displace.h"
#include "formulas/mips.h"
#include "surface/patch/patch_samples.h"
#include "surface/patch/surface.h"

namespace relief {

namespace {

std::array<Vec3f, 4> load_normals(const Surface& surface, const Quad& quad) {
    std::array<Vec3f, 4> normals;
    for (int k = 0; k < 4; ++k) normals[k] = unpack_normal(surface.frames[quad.vertex[k]]);
    return normals;
}

Vec3f blend_normals(const std::array<Vec3f, 4>& n, const Vec2f& at) {
    return scalar::interpolate_quad(n[0], n[1], n[2], n[3], at);
}

/// Normal of an undisplaced patch, turned to the side of the triangle that (u, v) is in.
Vec3f compute_plain_normal(const Surface& surface, const Quad& quad, float u, float v) {
    const std::array<Vec3f, 4> normals = load_normals(surface, quad);
    const Vec3f blended = quad.is_triangle()
                              ? scalar::interpolate_triangle(normals[0], normals[1], normals[2], {u, v})
                              : blend_normals(normals, {u, v});
    const bool is_upper = v > u && !quad.is_triangle();
    const Vec3f& p = surface.position(quad.vertex[0]);
    const Vec3f facet = cross(surface.position(quad.vertex[is_upper ? 2 : 1]) - p,
                              surface.position(quad.vertex[is_upper ? 3 : 2]) - p);
    return scalar::make_plain_normal(blended, facet);
}

/// Of the base and its frame; from a to b on the near side, from c to d on the far side, at s across.
scalar::SurfaceDerivative blend_difference(const VertexData& a, const VertexData& b, const VertexData& c,
                                           const VertexData& d, float s) {
    scalar::SurfaceDerivative result{};
    result.base = scalar::blend_difference(a.position, b.position, c.position, d.position, s);
    result.frame = {scalar::blend_difference(a.frame.t, b.frame.t, c.frame.t, d.frame.t, s),
                    scalar::blend_difference(a.frame.b, b.frame.b, c.frame.b, d.frame.b, s),
                    scalar::blend_difference(a.frame.n, b.frame.n, c.frame.n, d.frame.n, s)};
    return result;
}

} // namespace

Vec3f compute_shading_normal(const Surface& surface, uint32_t patch, int level, float u, float v) {
    if (surface.frames.empty()) return {};
    if (!surface.has_displacement) return compute_plain_normal(surface, surface.quads[patch], u, v);
    return compute_shading_normal(surface, PatchSamples(surface, patch), patch, level, u, v);
}

Vec3f compute_shading_normal(const Surface& surface, const PatchSamples& samples, uint32_t patch, int level,
                             float u, float v) {
    if (surface.frames.empty()) return {};
    const std::array<VertexData, 4>& c = samples.corners();
    scalar::SurfaceDerivative along_u = blend_difference(c[0], c[1], c[3], c[2], v);
    scalar::SurfaceDerivative along_v = blend_difference(c[0], c[3], c[1], c[2], u);
    if (const BicubicBase* base = samples.base())
        along_u.base = base->differentiate_u(u, v), along_v.base = base->differentiate_v(u, v);
    Vec3f normal = normalize(blend_normals({c[0].frame.n, c[1].frame.n, c[2].frame.n, c[3].frame.n}, {u, v}));
    if (normal == Vec3f{}) normal = normalize(cross(along_u.base, along_v.base));

    const uint32_t mips = surface.packed_mips(patch), normal_mip = scalar::choose_normal_mip(mips);
    const uint32_t normal_level = scalar::choose_normal_level(mips, uint32_t(level));
    const auto fetch = [&](float at_u, float at_v) {
        const Vec2f uv{scalar::blend_quad(c[0].uv.x, c[1].uv.x, c[2].uv.x, c[3].uv.x, at_u, at_v),
                       scalar::blend_quad(c[0].uv.y, c[1].uv.y, c[2].uv.y, c[3].uv.y, at_u, at_v)};
        return fetch_displacement(surface.map, c[0].tile, uv, normal_mip);
    };
    const auto find_ends = [&](float at, int low_edge, int high_edge) {
        return scalar::find_difference_ends(at, 0.5f / float(1u << normal_level),
                                            surface.is_seam(patch, low_edge),
                                            surface.is_seam(patch, high_edge));
    };
    const Vec2f ends_u = find_ends(u, 3, 1), ends_v = find_ends(v, 0, 2);
    along_u.displacement = (fetch(ends_u.y, v) - fetch(ends_u.x, v)) / (ends_u.y - ends_u.x);
    along_v.displacement = (fetch(u, ends_v.y) - fetch(u, ends_v.x)) / (ends_v.y - ends_v.x);
    if (!surface.map.is_tangent)
        return scalar::make_displaced_normal(scalar::displace_derivative(along_u, normal),
                                             scalar::displace_derivative(along_v, normal), normal);
    const Frame blended = blend_corners(c, u, v).frame;
    const scalar::Basis frame{blended.t, blended.b, blended.n};
    const Vec3f d = fetch(u, v);
    return scalar::make_displaced_normal(scalar::displace_derivative_through(along_u, frame, d, normal),
                                         scalar::displace_derivative_through(along_v, frame, d, normal),
                                         normal);
}

} // namespace relief
