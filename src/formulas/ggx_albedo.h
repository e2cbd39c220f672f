// Interpolated look-up of the GGX albedo table.
#if !defined(RELIEF_GGX_ALBEDO_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_GGX_ALBEDO_H
#include "formulas/ggx_table.h"
#endif
#include "formulas/begin.h"

/// Albedo = f0 * scale + f90 * bias.
struct GgxAlbedo {
    Float scale, bias;
};

/// Between entries a and b.
FN Vec2 blend_ggx_entries(const Uint a, const Uint b, const Float f) {
    return read_ggx_table(a) * (Float(1.0f) - f) + read_ggx_table(b) * f;
}

FN GgxAlbedo lookup_ggx_albedo(const Float roughness, const Float cos_theta) {
    Float y = clamp(roughness, Float(0.0f), Float(1.0f)) * Float(15.0f);
    Float x = sqrt(clamp(cos_theta, Float(0.0f), Float(1.0f))) * Float(15.0f);
    Float row = min(floor(y), Float(14.0f));
    Float column = min(floor(x), Float(14.0f));
    Uint i = Uint(row * Float(16.0f) + column);
    Vec2 above = blend_ggx_entries(i, i + Uint(1u), x - column);
    Vec2 below = blend_ggx_entries(i + Uint(16u), i + Uint(17u), x - column);
    Vec2 entry = above * (Float(1.0f) - (y - row)) + below * (y - row);
    GgxAlbedo result = {entry.x, entry.y};
    return result;
}

/// Cosine-weighted mean over the hemisphere.
FN GgxAlbedo lookup_ggx_average(const Float roughness) {
    Float y = clamp(roughness, Float(0.0f), Float(1.0f)) * Float(15.0f);
    Float row = min(floor(y), Float(14.0f));
    Uint i = Uint(kGgxAverages) + Uint(row);
    Vec2 entry = blend_ggx_entries(i, i + Uint(1u), y - row);
    GgxAlbedo result = {entry.x, entry.y};
    return result;
}

#include "formulas/end.h"
#endif
