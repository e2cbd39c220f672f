#include <algorithm>
#include <cmath>

#include "math/scalar.h"
#include "surface/patch_samples.h"
#include "surface/surface.h"

namespace relief {

namespace {

Vec3f blend(const Vec3f& a, const Vec3f& b, float s) { return a * (1 - s) + b * s; }

std::array<Vec3f, 4> load_normals(const Surface& surface, const Quad& quad) {
    std::array<Vec3f, 4> normals;
    for (int k = 0; k < 4; ++k) normals[k] = unpack_normal(surface.frames[quad.vertex[k]]);
    return normals;
}

Vec3f blend_normals(const std::array<Vec3f, 4>& n, float u, float v) {
    return blend(blend(n[0], n[1], u), blend(n[3], n[2], u), v);
}

/// Normal of an undisplaced patch, turned to the side of the triangle that (u, v) is in.
Vec3f compute_plain_normal(const Surface& surface, const Quad& quad, float u, float v) {
    const std::array<Vec3f, 4> normals = load_normals(surface, quad);
    const Vec3f normal =
        normalize(quad.is_triangle() ? normals[0] * (1 - u) + normals[1] * (u - v) + normals[2] * v
                                     : blend_normals(normals, u, v));
    const bool is_upper = v > u && !quad.is_triangle();
    const Vec3f& p = surface.positions[quad.vertex[0]];
    const Vec3f facet = cross(surface.positions[quad.vertex[is_upper ? 2 : 1]] - p,
                              surface.positions[quad.vertex[is_upper ? 3 : 2]] - p);
    if (normal == Vec3f{}) return normalize(facet);
    return dot(normal, facet) < 0 ? -normal : normal;
}

/// What the displacement adds to one derivative: its own, and the turn of the frame under it.
struct Derivative {
    Vec3f base;         ///< of the position
    Frame frame;        ///< of the frame
    Vec3f displacement; ///< of d
};

Vec3f displace_derivative(const DisplacementMap& map, const Derivative& along, const Frame& frame,
                          const Vec3f& d, const Vec3f& normal) {
    const Vec3f base = along.base - normal * dot(normal, along.base);
    const Vec3f& change = along.displacement;
    if (!map.is_tangent) return base + change;
    // A normal that grows shorter between the vertices would tilt the surface towards them.
    const Vec3f turn = along.frame.n - normal * dot(normal, along.frame.n);
    return base + frame.t * change.x + frame.b * change.y + frame.n * change.z + along.frame.t * d.x +
           along.frame.b * d.y + turn * d.z;
}

Derivative blend_difference(const VertexData& a, const VertexData& b, const VertexData& c,
                            const VertexData& d, float s) {
    const auto difference = [s](const Vec3f& p, const Vec3f& q, const Vec3f& r, const Vec3f& t) {
        return blend(q - p, t - r, s);
    };
    Derivative result{};
    result.base = difference(a.position, b.position, c.position, d.position);
    result.frame.t = difference(a.frame.t, b.frame.t, c.frame.t, d.frame.t);
    result.frame.b = difference(a.frame.b, b.frame.b, c.frame.b, d.frame.b);
    result.frame.n = difference(a.frame.n, b.frame.n, c.frame.n, d.frame.n);
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
    Derivative along_u = blend_difference(c[0], c[1], c[3], c[2], v);
    Derivative along_v = blend_difference(c[0], c[3], c[1], c[2], u);
    Vec3f normal = normalize(blend_normals(samples.normals(), u, v));
    if (normal == Vec3f{}) normal = normalize(cross(along_u.base, along_v.base));

    const auto fetch = [&](float at_u, float at_v) {
        const Vec2f uv{scalar::blend_quad(c[0].uv.x, c[1].uv.x, c[2].uv.x, c[3].uv.x, at_u, at_v),
                       scalar::blend_quad(c[0].uv.y, c[1].uv.y, c[2].uv.y, c[3].uv.y, at_u, at_v)};
        return fetch_displacement(surface.map, c[0].tile, uv);
    };
    // The uvs run on into the neighbour, except at a seam, where they would run into another part of the map.
    const float half = 0.5f / float(1u << level);
    const auto find_ends = [&](float at, int low_edge, int high_edge) {
        const float low = at - half, high = at + half;
        return std::array<float, 2>{surface.is_seam(patch, low_edge) ? std::max(low, 0.0f) : low,
                                    surface.is_seam(patch, high_edge) ? std::min(high, 1.0f) : high};
    };
    const auto ends_u = find_ends(u, 3, 1), ends_v = find_ends(v, 0, 2);
    along_u.displacement = (fetch(ends_u[1], v) - fetch(ends_u[0], v)) / (ends_u[1] - ends_u[0]);
    along_v.displacement = (fetch(u, ends_v[1]) - fetch(u, ends_v[0])) / (ends_v[1] - ends_v[0]);

    const Frame frame = blend_corners(c, u, v).frame;
    const Vec3f d = fetch(u, v);
    const Vec3f result = normalize(cross(displace_derivative(surface.map, along_u, frame, d, normal),
                                         displace_derivative(surface.map, along_v, frame, d, normal)));
    return result == Vec3f{} ? normal : result;
}

} // namespace relief
