// Shading normal of the displaced surface, continuous across cells and patches.
#if !defined(RELIEF_SHADING_NORMAL_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_SHADING_NORMAL_H
#include "formulas/basis.h"
#include "formulas/cross.h"
#endif
#include "formulas/begin.h"

FN Vec3 interpolate(const Vec3 a, const Vec3 b, const Float s) { return a * (Float(1.0f) - s) + b * s; }

/// Corners in their order around the patch.
FN Vec3 interpolate_quad(const Vec3 c0, const Vec3 c1, const Vec3 c2, const Vec3 c3, const Vec2 at) {
    return interpolate(interpolate(c0, c1, at.x), interpolate(c3, c2, at.x), at.y);
}

FN Vec3 interpolate_triangle(const Vec3 c0, const Vec3 c1, const Vec3 c2, const Vec2 at) {
    return c0 * (Float(1.0f) - at.x) + c1 * (at.x - at.y) + c2 * at.y;
}

/// Normal of a plain polygon, from its interpolated vertex normals and the hit triangle's own.
FN Vec3 make_plain_normal(const Vec3 blended, const Vec3 plane) {
    Vec3 zero = {Float(0.0f), Float(0.0f), Float(0.0f)};
    Vec3 normal = make_unit(blended);
    Vec3 turned = select(dot(normal, plane) < Float(0.0f), -normal, normal);
    return select(normal == zero, make_unit(plane), turned);
}

/// Derivatives, along u or along v, of the terms of a displaced point.
struct SurfaceDerivative {
    Vec3 base;         ///< of the position
    Basis frame;       ///< of the frame; it is not orthonormal
    Vec3 displacement; ///< of d
};

/// Derivative of a bilinear patch at `s` across: from p to q on the near side, r to t on the far side.
FN Vec3 blend_difference(const Vec3 p, const Vec3 q, const Vec3 r, const Vec3 t, const Float s) {
    return interpolate(q - p, t - r, s);
}

/// Ends of a central difference one cell wide about `at`. The difference extends into the neighbouring patch,
/// except at a uv seam, beyond which lies another part of the map.
FN Vec2 find_difference_ends(const Float at, const Float half_cell, const Bool is_low_seam,
                             const Bool is_high_seam) {
    Float low = at - half_cell;
    Float high = at + half_cell;
    Vec2 ends = {select(is_low_seam, max(low, Float(0.0f)), low),
                 select(is_high_seam, min(high, Float(1.0f)), high)};
    return ends;
}

/// Base derivative projected into the normal's plane, plus the derivative of the displacement.
FN Vec3 displace_derivative(const SurfaceDerivative along, const Vec3 normal) {
    return along.base - normal * dot(normal, along.base) + along.displacement;
}

/// The same for d in `frame`, by the product rule: derivative of d in the frame, d in that of the frame.
FN Vec3 displace_derivative_through(const SurfaceDerivative along, const Basis frame, const Vec3 d,
                                    const Vec3 normal) {
    Vec3 base = along.base - normal * dot(normal, along.base);
    Vec3 change = along.displacement;
    // An interpolated normal that shortens between the vertices would tilt the surface.
    Vec3 turn = along.frame.n - normal * dot(normal, along.frame.n);
    return base + frame.t * change.x + frame.b * change.y + frame.n * change.z + along.frame.t * d.x +
           along.frame.b * d.y + turn * d.z;
}

/// Normal from the displaced derivatives; `normal`, the interpolated one, where they are degenerate.
FN Vec3 make_displaced_normal(const Vec3 along_u, const Vec3 along_v, const Vec3 normal) {
    Vec3 zero = {Float(0.0f), Float(0.0f), Float(0.0f)};
    Vec3 result = make_unit(cross_exact(along_u, along_v));
    return select(result == zero, normal, result);
}

/// Shading normal bent just far enough that the mirror direction of `wo` stays above the geometric surface,
/// to avoid black pixels at grazing triangles. Both normals on the side of `wo`; unit vectors.
FN Vec3 bend_normal(const Vec3 shading, const Vec3 geometric, const Vec3 wo) {
    Vec3 mirrored = shading * (Float(2.0f) * dot(wo, shading)) - wo;
    Float lowest = min(Float(0.9f) * dot(wo, geometric), Float(0.01f));
    Float height = dot(mirrored, geometric);
    Bool is_low = height < lowest;
    Vec3 bent = shading;
    if (is_any(is_low)) {
        Vec3 lifted = normalize(mirrored + geometric * (lowest - height));
        bent = select(is_low, normalize(lifted + wo), bent);
    }
    return bent;
}

#include "formulas/end.h"
#endif
