// Energy-preserving Oren-Nayar: Portsmouth, Kutz and Hill 2025, EON: a practical energy-preserving rough
// diffuse BRDF (equations 9 to 21). Fujii's form of Oren and Nayar, and a lobe that returns what it leaves
// over.
#if !defined(RELIEF_EON_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_EON_H
#include "formulas/constants.h"
#endif
#include "formulas/begin.h"

const float kFonSingle = 0.5f - 2.0f / (3.0f * kPi);
const float kFonAverage = 2.0f / 3.0f - 28.0f / (15.0f * kPi);

/// Directional albedo of the single-scattering part in white, by the fit of the paper; error 1e-3.
FN Float fon_albedo(const Float roughness, const Float cos_theta) {
    Float m = Float(1.0f) - cos_theta;
    Float g = Float(-0.332181442f) + m * Float(0.0714429953f);
    g = m * (Float(0.0571085289f) + m * (Float(0.491881867f) + m * g));
    return (Float(1.0f) + roughness * g) / (Float(1.0f) + Float(kFonSingle) * roughness);
}

FN Float eon_multiple(const Float color, const Float average) {
    return color * color * average / (Float(1.0f) - color * (Float(1.0f) - average));
}

/// BRDF without the cosine, both directions above the surface.
FN Vec3 evaluate_eon(const Vec3 color, const Float roughness, const Vec3 wo, const Vec3 wi) {
    Float one = Float(1.0f);
    Float s = dot(wo, wi) - wo.z * wi.z;
    Float ratio = select(s > Float(0.0f), s / max(wo.z, wi.z), s);
    Float factor = one / (one + Float(kFonSingle) * roughness);
    Float single = Float(1.0f / kPi) * factor * (one + roughness * ratio);
    Float average = factor * (one + Float(kFonAverage) * roughness);
    Float left = max(Float(0.0f), one - fon_albedo(roughness, wo.z)) *
                 max(Float(0.0f), one - fon_albedo(roughness, wi.z));
    Float multiple = Float(1.0f / kPi) * left / max(one - average, Float(1e-7f));
    Vec3 result = {color.x * single + eon_multiple(color.x, average) * multiple,
                   color.y * single + eon_multiple(color.y, average) * multiple,
                   color.z * single + eon_multiple(color.z, average) * multiple};
    return result;
}

#include "formulas/end.h"
#endif
