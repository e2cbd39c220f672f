// Light at a smooth face of glass, inside a body of it, and at a thin wall.
#if !defined(RELIEF_GLASS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_GLASS_H
#include "formulas/glass_parameters.h"
#include "formulas/power.h"
#endif
#include "formulas/begin.h"

/// Below it, half vectors of refraction lose their digits.
const float kLeastGlassIor = 1.01f;

struct Refraction {
    Float reflected; ///< Fresnel's reflectance of unpolarised light; 1 beyond the critical angle
    Float cosine;    ///< of the refracted direction to the reversed normal; 0 beyond that angle
};

/// `cosine`: of the incident direction, >= 0; `ior`: of the far side over the near one.
FN Refraction refract_at(const Float cosine, const Float ior) {
    Float one = Float(1.0f);
    Float sine2 = max(Float(0.0f), one - cosine * cosine) / (ior * ior);
    Float refracted = sqrt(max(Float(0.0f), one - sine2));
    Float across = (cosine - ior * refracted) / max(cosine + ior * refracted, Float(1e-9f));
    Float along = (ior * cosine - refracted) / max(ior * cosine + refracted, Float(1e-9f));
    Float reflected = Float(0.5f) * (across * across + along * along);
    Refraction result = {select(sine2 < one, reflected, one), refracted};
    return result;
}

/// What is left of light after ways through a medium.
FN Vec3 absorb_along(const Vec3 depth, const Float way) {
    Float back = Float(0.0f) - min(way, Float(1e30f));
    Vec3 left = {find_power_of_two(depth.x * back), find_power_of_two(depth.y * back),
                 find_power_of_two(depth.z * back)};
    return left;
}

/// What a thin wall sends back and lets through, all reflections between its two faces summed up (OpenPBR
/// 1.1, "Thin-walled mode").
struct WallLight {
    Vec3 reflected, passed;
};

/// x: sent back, y: let through; `left`: of light once through the wall.
FN Vec2 sum_up_reflections(const Float fresnel, const Float left) {
    Float one = Float(1.0f);
    Float through = one - fresnel;
    Float passed = through * through * left / max(one - fresnel * fresnel * left * left, Float(1e-6f));
    Vec2 result = {fresnel + passed * fresnel * left, passed};
    return result;
}

FN WallLight meet_wall(const GlassParameters g, const Float cosine) {
    Refraction face = refract_at(cosine, g.ior);
    Vec3 left = absorb_along(g.depth, Float(1.0f) / max(face.cosine, Float(1e-6f)));
    Vec2 x = sum_up_reflections(face.reflected, left.x);
    Vec2 y = sum_up_reflections(face.reflected, left.y);
    Vec2 z = sum_up_reflections(face.reflected, left.z);
    Vec3 reflected = {x.x, y.x, z.x};
    Vec3 passed = {x.y, y.y, z.y};
    WallLight result = {reflected, passed};
    return result;
}

#include "formulas/end.h"
#endif
