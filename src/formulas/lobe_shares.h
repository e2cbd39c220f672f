// The diffuse part of what surfaces scatter, for pictures with layers of it. The rest is specular.
#if !defined(RELIEF_LOBE_SHARES_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_LOBE_SHARES_H
#include "formulas/layered_bsdf.h"
#endif
#include "formulas/begin.h"

/// The diffuse part of evaluate_bsdf: of the base under the clear surface.
FN Vec3 evaluate_diffuse(const Bsdf b, const Vec3 wo, const Vec3 wi) {
    Float zero = Float(0.0f);
    Float way = wi.z;
    if (is_any(!is_diffuse(b))) {
        GgxAlbedo at_i = lookup_ggx_albedo(b.roughness, wi.z);
        Float base = b.escape_coat * max(zero, Float(1.0f) - coat_albedo(b, at_i)) * wi.z;
        way = select(is_diffuse(b), way, base);
    }
    return select(wo.z > zero && wi.z > zero, b.diffuse * way, make_grey(zero));
}

/// The diffuse part of evaluate_above_layers: of the dielectric base, with what its layers leave over, and of
/// the fuzz.
FN Vec3 evaluate_diffuse_above_layers(const LayeredBsdf b, const LayerTable table, const Vec3 wo,
                                      const Vec3 wi) {
    Float one = Float(1.0f);
    Float zero = Float(0.0f);
    LayerParameters l = b.surface.layers;
    LayerTerms o = b.at_o;
    LayerTerms i = make_layer_terms(b.surface, table, b.roughness, wi);
    Vec3 value = evaluate_eon(b.surface.base_color, l.diffuse_roughness, wo, wi) *
                 ((one - l.metallic) * o.base * i.base * wi.z);
    Vec3 rest = b.rests.dielectric * (o.rest_dielectric * i.rest_dielectric) * wi.z;
    if (is_any(l.coat_weight > zero)) {
        Vec3 color = multiply_colors(pass_coat_color(l, o.path, i.path), b.darkening);
        value = multiply_colors(value, blend_from_one(color * (o.coat * i.coat), l.coat_weight));
        rest = multiply_colors(rest, blend_from_one(color, l.coat_weight));
    }
    if (is_any(l.fuzz_weight > zero)) {
        Vec3 h = normalize(wo + wi);
        Float fuzz = l.fuzz_weight * evaluate_fuzz(l, h.z, wo.z, wi.z) * wi.z;
        value = value * (o.fuzz * i.fuzz) + l.fuzz_color * fuzz;
    }
    return value + rest;
}

/// The diffuse part of evaluate_layered_bsdf.
FN Vec3 evaluate_layered_diffuse(const LayeredBsdf b, const LayerTable table, const Vec3 wo, const Vec3 wi) {
    Float zero = Float(0.0f);
    Bool is_above = wo.z > zero && wi.z > zero;
    Vec3 result = make_grey(zero);
    if (is_any(is_above)) result = select(is_above, evaluate_diffuse_above_layers(b, table, wo, wi), result);
    return result;
}

FN Float find_share(const Float part, const Float whole) {
    Float zero = Float(0.0f);
    Float one = Float(1.0f);
    Bool is_lit = whole > zero;
    return select(is_lit, min(part / select(is_lit, whole, one), one), zero);
}

/// Of a part of what a surface scatters, in [0, 1] each, so that shares of light add up to it.
FN Vec3 find_shares(const Vec3 part, const Vec3 whole) {
    Vec3 result = {find_share(part.x, whole.x), find_share(part.y, whole.y), find_share(part.z, whole.z)};
    return result;
}

#include "formulas/end.h"
#endif
