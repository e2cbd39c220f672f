// Metallic-roughness surface in the local frame (shading normal = z): a GGX lobe over a diffuse base, both
// energy conserving.
// Multiple-scattering compensation and coupling of coat and base: Kulla and Conty 2017, Revisiting Physically
// Based Shading; both are reciprocal, and a white surface reflects all light.
#if !defined(RELIEF_BSDF_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_BSDF_H
#include "formulas/constants.h"
#include "formulas/facets.h"
#include "formulas/ggx_albedo.h"
#include "formulas/warp.h"
#endif
#include "formulas/begin.h"

struct BsdfParameters {
    Vec3 base_color; ///< reflectance of the diffuse base; of the metal at normal incidence
    Float roughness; ///< [0, 1]; alpha is its square, at least kMinAlpha
    Float metallic;  ///< [0, 1]
    Float ior;       ///< of the clear surface, >= 1; 1: none
};

/// Evaluated for one outgoing direction.
struct Bsdf {
    Vec3 f0;   ///< Schlick's Fresnel at normal incidence
    Float f90; ///< and at grazing incidence
    Float alpha, roughness;
    Vec3 multiple; ///< multiple scattering: times (1 - E(o)) (1 - E(i))
    Vec3 diffuse;  ///< of the base: times (1 - C(o)) (1 - C(i)), C the albedo of the dielectric coat
    Float coat_f0, coat_f90, coat_multiple;
    Float escape_multiple;      ///< 1 - E(o)
    Float escape_coat;          ///< 1 - C(o)
    Float specular_probability; ///< of sampling the microfacet lobe
};

/// Density is per solid angle.
struct BsdfValue {
    Vec3 value; ///< BSDF times the cosine of the incoming direction
    Float pdf;
};

struct BsdfSample {
    Vec3 direction;
    Vec3 weight; ///< value / pdf; zero for a direction below the surface
    Float pdf;
};

FN Vec3 make_grey(const Float value) {
    Vec3 grey = {value, value, value};
    return grey;
}

FN Float luminance(const Vec3 c) {
    return Float(0.2126f) * c.x + Float(0.7152f) * c.y + Float(0.0722f) * c.z;
}

/// Light that leaves after multiple scattering (Hill 2018, part 2): f^2 E / (1 - f (1 - E)).
FN Float multiple_scattering(const Float f, const Float average_albedo) {
    return f * f * average_albedo / (Float(1.0f) - f * (Float(1.0f) - average_albedo));
}

/// Mean of Schlick's Fresnel over the cosine-weighted hemisphere.
FN Float average_fresnel(const Float f0, const Float f90) { return f0 + (f90 - f0) * Float(1.0f / 21.0f); }

/// Albedo of the dielectric coat, multiple scattering included.
FN Float coat_albedo(const Bsdf b, const GgxAlbedo e) {
    return b.coat_f0 * e.scale + b.coat_f90 * e.bias + b.coat_multiple * (Float(1.0f) - e.scale - e.bias);
}

/// For a material without coat or metal; equals make_general_bsdf for every outgoing direction.
FN Bsdf make_diffuse_bsdf(const BsdfParameters p) {
    Float zero = Float(0.0f);
    Bsdf b;
    b.f0 = make_grey(zero);
    b.f90 = zero;
    b.roughness = p.roughness;
    b.alpha = find_alpha(p.roughness);
    b.multiple = make_grey(zero);
    b.diffuse = p.base_color * Float(1.0f / kPi);
    b.coat_f0 = zero;
    b.coat_f90 = zero;
    b.coat_multiple = zero;
    b.escape_multiple = zero;
    b.escape_coat = Float(1.0f);
    b.specular_probability = zero;
    return b;
}

/// Whether only the diffuse base scatters, unattenuated.
FN Bool is_diffuse(const Bsdf b) { return b.f90 == Float(0.0f); }

FN Bsdf make_general_bsdf(const BsdfParameters p, const Float cos_o) {
    Float one = Float(1.0f);
    Float dielectric = one - p.metallic;
    Float root = (p.ior - one) / (p.ior + one);
    Float coat_f0 = root * root;
    // Below 2 % reflectance at normal incidence the whole coat fades out, vanishing at ior 1.
    Float coat_f90 = min(one, Float(50.0f) * coat_f0);
    GgxAlbedo average = lookup_ggx_average(p.roughness);
    GgxAlbedo at_o = lookup_ggx_albedo(p.roughness, cos_o);
    Float e_average = average.scale + average.bias;
    Float e_o = at_o.scale + at_o.bias;
    Bsdf b;
    b.f0 = p.base_color * p.metallic + make_grey(dielectric * coat_f0);
    b.f90 = p.metallic + dielectric * coat_f90;
    b.roughness = p.roughness;
    b.alpha = find_alpha(p.roughness);
    b.coat_f0 = coat_f0;
    b.coat_f90 = coat_f90;
    b.coat_multiple = multiple_scattering(average_fresnel(coat_f0, coat_f90), e_average);
    Float from_coat = dielectric * b.coat_multiple;
    Vec3 f_multiple = {
        p.metallic * multiple_scattering(average_fresnel(p.base_color.x, one), e_average) + from_coat,
        p.metallic * multiple_scattering(average_fresnel(p.base_color.y, one), e_average) + from_coat,
        p.metallic * multiple_scattering(average_fresnel(p.base_color.z, one), e_average) + from_coat};
    b.escape_multiple = max(Float(0.0f), one - e_o);
    b.escape_coat = max(Float(0.0f), one - coat_albedo(b, at_o));
    b.multiple = f_multiple * (one / (Float(kPi) * max(one - e_average, Float(1e-6f))));
    b.diffuse = p.base_color * (dielectric / (Float(kPi) * max(one - coat_albedo(b, average), Float(1e-6f))));
    Float specular = luminance(b.f0) * at_o.scale + b.f90 * at_o.bias;
    Float cosine =
        luminance(f_multiple) * b.escape_multiple + dielectric * luminance(p.base_color) * b.escape_coat;
    // At least a fifth for the specular lobe: its Fresnel factor can be far above its mean.
    Float share = clamp(specular / (specular + cosine), Float(0.2f), one);
    b.specular_probability = select(specular > Float(0.0f), share, Float(0.0f));
    return b;
}

FN Bsdf select_bsdf(const Bool condition, const Bsdf a, const Bsdf b) {
    Bsdf result;
    result.f0 = select(condition, a.f0, b.f0);
    result.f90 = select(condition, a.f90, b.f90);
    result.alpha = select(condition, a.alpha, b.alpha);
    result.roughness = select(condition, a.roughness, b.roughness);
    result.multiple = select(condition, a.multiple, b.multiple);
    result.diffuse = select(condition, a.diffuse, b.diffuse);
    result.coat_f0 = select(condition, a.coat_f0, b.coat_f0);
    result.coat_f90 = select(condition, a.coat_f90, b.coat_f90);
    result.coat_multiple = select(condition, a.coat_multiple, b.coat_multiple);
    result.escape_multiple = select(condition, a.escape_multiple, b.escape_multiple);
    result.escape_coat = select(condition, a.escape_coat, b.escape_coat);
    result.specular_probability = select(condition, a.specular_probability, b.specular_probability);
    return result;
}

/// `cos_o`: cosine of the outgoing direction, > 0.
FN Bsdf make_bsdf(const BsdfParameters p, const Float cos_o) {
    Bool is_general = p.metallic > Float(0.0f) || p.ior > Float(1.0f);
    Bsdf b = make_diffuse_bsdf(p);
    if (is_any(is_general)) b = select_bsdf(is_general, make_general_bsdf(p, cos_o), b);
    return b;
}

FN Vec3 schlick_fresnel(const Vec3 f0, const Float f90, const Float cos_h) {
    Float m = clamp(Float(1.0f) - cos_h, Float(0.0f), Float(1.0f));
    Float m5 = m * m * m * m * m;
    Vec3 result = {f0.x + (f90 - f0.x) * m5, f0.y + (f90 - f0.y) * m5, f0.z + (f90 - f0.z) * m5};
    return result;
}

/// Both directions above the surface.
FN BsdfValue evaluate_general_bsdf(const Bsdf b, const Vec3 wo, const Vec3 wi) {
    Float one = Float(1.0f);
    Vec3 h = normalize(wo + wi);
    Float lambda_o = ggx_lambda(b.alpha, wo.z);
    Float lambda_i = ggx_lambda(b.alpha, wi.z);
    Vec2 alpha = {b.alpha, b.alpha};
    Float lobe = ggx_distribution(alpha, h) / (Float(4.0f) * wo.z);
    Vec3 specular = schlick_fresnel(b.f0, b.f90, dot(wo, h)) * (lobe / (one + lambda_o + lambda_i));
    GgxAlbedo at_i = lookup_ggx_albedo(b.roughness, wi.z);
    Float multiple = b.escape_multiple * max(Float(0.0f), one - at_i.scale - at_i.bias) * wi.z;
    Float diffuse = b.escape_coat * max(Float(0.0f), one - coat_albedo(b, at_i)) * wi.z;
    BsdfValue result;
    result.value = specular + b.multiple * multiple + b.diffuse * diffuse;
    result.pdf = b.specular_probability * lobe / (one + lambda_o) +
                 (one - b.specular_probability) * cosine_hemisphere_pdf(wi.z);
    return result;
}

/// Value and density of `wi` for light leaving along `wo`; zero when either is below. Unit vectors.
FN BsdfValue evaluate_bsdf(const Bsdf b, const Vec3 wo, const Vec3 wi) {
    Float zero = Float(0.0f);
    Bool is_above = wo.z > zero && wi.z > zero;
    BsdfValue result;
    // Purely diffuse materials.
    result.value = select(is_above, b.diffuse * wi.z, make_grey(zero));
    result.pdf = select(is_above, cosine_hemisphere_pdf(wi.z), zero);
    Bool is_general = is_above && !is_diffuse(b);
    if (is_any(is_general)) {
        BsdfValue general = evaluate_general_bsdf(b, wo, wi);
        result.value = select(is_general, general.value, result.value);
        result.pdf = select(is_general, general.pdf, result.pdf);
    }
    return result;
}

/// Samples an incoming direction for `wo`: `u_lobe` in [0, 1) selects the lobe, `u` the direction within it.
FN BsdfSample sample_bsdf(const Bsdf b, const Vec3 wo, const Float u_lobe, const Vec2 u) {
    Vec3 wi = square_to_cosine_hemisphere(u);
    Bool is_specular = u_lobe < b.specular_probability;
    Vec2 alpha = {b.alpha, b.alpha};
    if (is_any(is_specular)) wi = select(is_specular, sample_ggx_reflection(alpha, wo, u), wi);
    wi = normalize(wi);
    BsdfValue v = evaluate_bsdf(b, wo, wi);
    Bool is_possible = v.pdf > Float(0.0f);
    Float share = select(is_possible, Float(1.0f) / select(is_possible, v.pdf, Float(1.0f)), Float(0.0f));
    BsdfSample result = {wi, v.value * share, v.pdf};
    return result;
}

/// Rounding may put a grazing viewer onto the horizon, where the BSDF is undefined.
FN Vec3 lift_viewer(const Vec3 wo_local) {
    Vec3 lifted = {wo_local.x, wo_local.y, max(wo_local.z, Float(1e-4f))};
    return normalize(lifted);
}

#include "formulas/end.h"
#endif
