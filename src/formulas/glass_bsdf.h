// Rough glass in the local frame of a viewer above the surface: GGX facets that reflect and refract by
// Fresnel's equations (Walter, Marschner, Li and Torrance 2007, Microfacet Models for Refraction through
// Rough Surfaces), with the shadowing of formulas/bsdf.h. Scattered once: what facets reflect onto others is
// lost. Values are of radiance: they are divided by the square of the ior that the light comes out of, times
// that of the one it goes into.
#if !defined(RELIEF_GLASS_BSDF_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_GLASS_BSDF_H
#include "formulas/bsdf.h"
#include "formulas/glass.h"
#endif
#include "formulas/begin.h"

struct GlassBsdf {
    Facets facets;
    Float ior;       ///< of the far side over the viewer's
    Vec3 reflection; ///< factor of what is reflected
    GlassParameters glass;
};

/// What a facet does.
struct FacetLight {
    Vec3 reflected, passed;
    Float share;  ///< probability of drawing reflection
    Float cosine; ///< of the refracted direction
};

FN GlassBsdf make_glass_bsdf(const GlassParameters g, const Float roughness, const Bool is_inside) {
    Bool is_leaving = is_inside && g.kind < Float(kRoughWall);
    GlassBsdf b;
    b.facets = make_facets(roughness, g.anisotropy);
    b.ior = select(is_leaving, Float(1.0f) / g.ior, g.ior);
    b.reflection = select(is_leaving, make_grey(Float(1.0f)), g.specular_color);
    b.glass = g;
    return b;
}

/// A clear wall reflects all that comes here: what passes it never does (formulas/glass_vertex.h).
FN FacetLight meet_facet(const GlassBsdf b, const Float cosine) {
    Float one = Float(1.0f);
    Refraction face = refract_at(cosine, b.ior);
    FacetLight light;
    light.reflected = make_grey(face.reflected);
    light.passed = b.glass.tint * (one - face.reflected);
    light.share = face.reflected;
    light.cosine = face.cosine;
    Bool is_wall = b.glass.kind >= Float(kRoughWall);
    if (is_any(is_wall)) {
        Bool is_clear = b.glass.kind >= Float(kClearWall);
        WallLight wall = meet_wall(b.glass, cosine);
        Float reflected = luminance(wall.reflected);
        Float share = reflected / max(reflected + luminance(wall.passed), Float(1e-6f));
        light.reflected = select(is_wall, select(is_clear, make_grey(one), wall.reflected), light.reflected);
        light.passed = select(is_wall, select(is_clear, make_grey(Float(0.0f)), wall.passed), light.passed);
        light.share = select(is_wall, select(is_clear, one, share), light.share);
    }
    return light;
}

/// Value and density of `wi`, on either side, for light that leaves along `wo`, above. Unit vectors.
FN BsdfValue evaluate_glass_bsdf(const GlassBsdf b, const Vec3 wo, const Vec3 wi) {
    Float one = Float(1.0f);
    Float zero = Float(0.0f);
    Bool is_reflected = wi.z > zero;
    Bool is_refracted = !is_reflected && b.glass.kind < Float(kRoughWall);
    // A wall lets through the mirror image of what it would reflect.
    Vec3 far = {wi.x, wi.y, select(is_refracted, wi.z, abs(wi.z))};
    Float ior = select(is_refracted, b.ior, one);
    Vec3 h = normalize(wo + far * ior);
    h = select(h.z < zero, h * Float(-1.0f), h);
    Float cos_o = dot(wo, h);
    Float cos_i = dot(far, h);
    Bool is_possible = cos_o > zero && wo.z > zero && abs(wi.z) > zero && (cos_i < zero || !is_refracted);
    FacetLight light = meet_facet(b, max(cos_o, zero));
    // The solid angle of directions over that of half vectors.
    Float turn = cos_o + ior * cos_i;
    Float spread = select(is_refracted, cos_o * abs(cos_i) / max(turn * turn, Float(1e-12f)), Float(0.25f));
    Float lobe = ggx_distribution(b.facets.alpha, h) * spread / wo.z;
    Vec3 unsigned_wi = {wi.x, wi.y, abs(wi.z)};
    Float lambda_o = facets_lambda(b.facets, wo);
    Float lambda_i = facets_lambda(b.facets, unsigned_wi);
    Vec3 reflected = {light.reflected.x * b.reflection.x, light.reflected.y * b.reflection.y,
                      light.reflected.z * b.reflection.z};
    Vec3 value = select(is_reflected, reflected, light.passed) * (lobe / (one + lambda_o + lambda_i));
    Float share = select(is_reflected, light.share, one - light.share);
    Float pdf = share * lobe * select(is_refracted, ior * ior, one) / (one + lambda_o);
    BsdfValue result;
    result.value = select(is_possible, value, make_grey(zero));
    result.pdf = select(is_possible, pdf, zero);
    return result;
}

/// Samples an incoming direction for `wo`: `u_lobe` in [0, 1) selects reflection or not, `u` the facet.
FN BsdfSample sample_glass_bsdf(const GlassBsdf b, const Vec3 wo, const Float u_lobe, const Vec2 u) {
    Float zero = Float(0.0f);
    Vec3 h = sample_ggx_normal(b.facets.alpha, wo, u);
    Float cos_o = max(dot(wo, h), zero);
    FacetLight light = meet_facet(b, cos_o);
    Bool is_reflected = u_lobe < light.share;
    Bool is_wall = b.glass.kind >= Float(kRoughWall);
    Vec3 mirrored = h * (Float(2.0f) * cos_o) - wo;
    Vec3 through = {mirrored.x, mirrored.y, zero - mirrored.z};
    Float inverse = Float(1.0f) / b.ior;
    Vec3 refracted = h * (cos_o * inverse - light.cosine) - wo * inverse;
    Vec3 wi = normalize(select(is_reflected, mirrored, select(is_wall, through, refracted)));
    // A facet may send light to the side that it does not belong to; further facets would take it.
    Bool is_above = wi.z > zero;
    Bool is_kept = (is_reflected && is_above) || (!is_reflected && !is_above);
    BsdfValue v = evaluate_glass_bsdf(b, wo, wi);
    Bool is_possible = is_kept && v.pdf > zero;
    Float weight = select(is_possible, Float(1.0f) / select(is_possible, v.pdf, Float(1.0f)), zero);
    BsdfSample result = {wi, v.value * weight, select(is_kept, v.pdf, zero)};
    return result;
}

#include "formulas/end.h"
#endif
