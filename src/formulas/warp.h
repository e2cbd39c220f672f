// Warps of the unit square to other domains, with their densities. Local frames have z up.
#if !defined(RELIEF_WARP_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_WARP_H
#include "formulas/basis.h"
#include "formulas/constants.h"
#include "formulas/trig.h"
#endif
#include "formulas/begin.h"

/// Concentric map onto the unit disk (Shirley and Chiu 1997), branchless. Density 1 / pi.
FN Vec2 square_to_disk(const Vec2 u) {
    Float x = Float(2.0f) * u.x - Float(1.0f);
    Float y = Float(2.0f) * u.y - Float(1.0f);
    Bool is_x_major = abs(x) > abs(y);
    Float r = select(is_x_major, x, y);
    Float ratio = select(is_x_major, y, x) / select(r == Float(0.0f), Float(1.0f), r);
    Float angle = Float(0.25f * kPi) * ratio;
    Float phi = select(is_x_major, angle, Float(0.5f * kPi) - angle);
    SinCos at = find_sin_cos(phi);
    Vec2 result = {r * at.cosine, r * at.sine};
    return result;
}

/// Directions about +z with density cos / pi (Malley's method).
FN Vec3 square_to_cosine_hemisphere(const Vec2 u) {
    Vec2 d = square_to_disk(u);
    Vec3 result = {d.x, d.y, sqrt(max(Float(0.0f), Float(1.0f) - d.x * d.x - d.y * d.y))};
    return result;
}

FN Float cosine_hemisphere_pdf(const Float cos_theta) {
    return max(cos_theta, Float(0.0f)) * Float(1.0f / kPi);
}

/// Uniform directions in the cone about +z whose half angle has cosine 1 - height; height 2 is the whole
/// sphere. Passing the height instead of the cosine keeps narrow cones exact.
FN Vec3 square_to_cone(const Vec2 u, const Float height) {
    Float drop = u.x * height;
    Float sin_theta = sqrt(max(Float(0.0f), drop * (Float(2.0f) - drop)));
    SinCos at = find_sin_cos(Float(2.0f * kPi) * u.y);
    Vec3 result = {sin_theta * at.cosine, sin_theta * at.sine, Float(1.0f) - drop};
    return result;
}

FN Float cone_pdf(const Float height) { return Float(1.0f) / (Float(2.0f * kPi) * height); }

FN Vec3 square_to_sphere(const Vec2 u) { return square_to_cone(u, Float(2.0f)); }

FN Float sphere_pdf() { return Float(0.25f / kPi); }

/// Uniform point of the triangle y <= x in the unit square (Heitz 2019). Density 2.
FN Vec2 square_to_triangle(const Vec2 u) {
    Bool is_y_major = u.y > u.x;
    Float half_x = Float(0.5f) * u.x;
    Float half_y = Float(0.5f) * u.y;
    // Barycentric weights of the standard map's first two axes; x = 1 - b0, y = b1 give y <= x.
    Float b0 = select(is_y_major, half_x, u.x - half_y);
    Float b1 = select(is_y_major, u.y - half_x, half_y);
    Vec2 result = {Float(1.0f) - b0, b1};
    return result;
}

#include "formulas/end.h"
#endif
