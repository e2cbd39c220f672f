// Microfacets in the local frame (shading normal = z, tangent = x): GGX (Walter et al. 2007) with the
// shadowing of Heitz 2014, of two widths of slopes, one along the tangent and one along the bitangent.
// Surfaces that are alike in all directions have them equal, and formulas of one width.
#if !defined(RELIEF_FACETS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_FACETS_H
#include "formulas/constants.h"
#include "formulas/trig.h"
#endif
#include "formulas/begin.h"

const float kMinAlpha = 1e-3f;

struct Facets {
    Vec2 alpha;        ///< along tangent and bitangent
    Bool is_stretched; ///< they are not one number
};

FN Float find_alpha(const Float roughness) { return max(roughness * roughness, Float(kMinAlpha)); }

/// OpenPBR 1.1, "Microfacet model": the squares of the two widths have one mean, whatever the anisotropy.
FN Facets make_facets(const Float roughness, const Float anisotropy) {
    Float alpha = find_alpha(roughness);
    Facets f;
    f.alpha.x = alpha;
    f.alpha.y = alpha;
    f.is_stretched = anisotropy > Float(0.0f);
    if (is_any(f.is_stretched)) {
        Float narrow = Float(1.0f) - anisotropy;
        Float along = roughness * roughness * sqrt(Float(2.0f) / (Float(1.0f) + narrow * narrow));
        Vec2 stretched = {max(along, Float(kMinAlpha)), max(along * narrow, Float(kMinAlpha))};
        f.alpha = select(f.is_stretched, stretched, f.alpha);
    }
    return f;
}

/// Smith's lambda of GGX; cos_theta > 0.
FN Float ggx_lambda(const Float alpha, const Float cos_theta) {
    Float cos2 = cos_theta * cos_theta;
    Float tan2 = max(Float(0.0f), Float(1.0f) - cos2) / cos2;
    return Float(0.5f) * (sqrt(Float(1.0f) + alpha * alpha * tan2) - Float(1.0f));
}

/// The same for any direction above the surface.
FN Float facets_lambda(const Facets f, const Vec3 w) {
    Float lambda = ggx_lambda(f.alpha.x, w.z);
    if (is_any(f.is_stretched)) {
        Float x = f.alpha.x * w.x;
        Float y = f.alpha.y * w.y;
        Float slope2 = (x * x + y * y) / (w.z * w.z);
        Float stretched = Float(0.5f) * (sqrt(Float(1.0f) + slope2) - Float(1.0f));
        lambda = select(f.is_stretched, stretched, lambda);
    }
    return lambda;
}

/// Normal distribution; h a unit vector. Avoids 1 - h.z^2, which suffers cancellation for smooth surfaces.
FN Float ggx_distribution(const Vec2 alpha, const Vec3 h) {
    Float x = h.x / alpha.x;
    Float y = h.y / alpha.y;
    Float k = x * x + y * y + h.z * h.z;
    return Float(1.0f) / (Float(kPi) * alpha.x * alpha.y * k * k);
}

/// A visible microfacet normal (Dupuy and Benyoub 2023, spherical caps).
FN Vec3 sample_ggx_normal(const Vec2 alpha, const Vec3 wo, const Vec2 u) {
    Vec3 stretched = {alpha.x * wo.x, alpha.y * wo.y, wo.z};
    Vec3 o = normalize(stretched);
    SinCos phi = find_sin_cos(Float(2.0f * kPi) * u.x);
    Float z = (Float(1.0f) - u.y) * (Float(1.0f) + o.z) - o.z;
    Float sin_theta = sqrt(max(Float(0.0f), Float(1.0f) - z * z));
    Vec3 unstretched = {alpha.x * (sin_theta * phi.cosine + o.x), alpha.y * (sin_theta * phi.sine + o.y),
                        z + o.z};
    return normalize(unstretched);
}

/// Reflection of `wo` at such a normal.
FN Vec3 sample_ggx_reflection(const Vec2 alpha, const Vec3 wo, const Vec2 u) {
    Vec3 h = sample_ggx_normal(alpha, wo, u);
    return h * (Float(2.0f) * dot(wo, h)) - wo;
}

/// Square of the cosine of a direction's azimuth about the tangent; along the normal 0.
FN Float find_azimuth(const Vec3 w) {
    Float x2 = w.x * w.x;
    return min(x2 / max(x2 + w.y * w.y, Float(1e-20f)), Float(1.0f));
}

/// Roughness of facets of one width that reflect at least about as much of the light from `w` as those of two
/// do: across the tangent they have the lesser one, along it the greater one.
FN Float find_seen_roughness(const Float roughness, const Float anisotropy, const Vec3 w) {
    Float seen = roughness;
    if (is_any(anisotropy > Float(0.0f))) {
        Facets f = make_facets(roughness, anisotropy);
        Float azimuth = find_azimuth(w);
        Float least = f.alpha.y * f.alpha.y;
        Float alpha2 = least + (f.alpha.x * f.alpha.x - least) * azimuth * sqrt(azimuth);
        seen = select(f.is_stretched, sqrt(sqrt(alpha2)), seen);
    }
    return seen;
}

#include "formulas/end.h"
#endif
