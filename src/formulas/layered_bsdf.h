// The opaque part of OpenPBR 1.1 (Andersson, Edmondson, Guertault, Herubel, King, Kutz, Machizaud,
// Portsmouth, Servant, Stone 2024) in the local frame: fuzz over coat over a mix of metal and glossy-diffuse
// dielectric. Each lobe is weighed by what the layers above let through on both ways, which is reciprocal;
// what all of them leave over in white goes into one more lobe of product form (Kulla and Conty 2017), so
// that a stack that absorbs nothing reflects all light: docs/decisions/openpbr.md.
#if !defined(RELIEF_LAYERED_BSDF_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_LAYERED_BSDF_H
#include "formulas/bsdf.h"
#include "formulas/eon.h"
#include "formulas/layer_albedo.h"
#include "formulas/power.h"
#endif
#include "formulas/begin.h"

struct LayeredSurface {
    Vec3 base_color; ///< reflectance of the diffuse base; of the metal at normal incidence
    Float roughness; ///< [0, 1], of the base
    LayerParameters layers;
};

/// What one direction meets.
struct LayerTerms {
    Float fuzz;     ///< let through by the fuzz
    Float coat;     ///< and by a coat of weight 1
    Float base;     ///< and by the surface of the dielectric
    Float path;     ///< length of the way through the coat, in its thicknesses
    Float specular; ///< albedo of the surface of the dielectric
    Float rest_dielectric, rest_metal;
};

/// Probabilities of sampling a lobe; else a cosine.
struct LobeShares {
    Float base, coat, fuzz;
};

/// Colours that the rests are returned in.
struct RestColors {
    Vec3 dielectric, metal;
};

/// Evaluated for one outgoing direction.
struct LayeredBsdf {
    LayeredSurface surface;
    Float roughness; ///< of the base under the coat
    Facets facets, coat_facets;
    Vec3 metal_f0, metal_edge; ///< Fresnel of the metal times its share
    Float metal_f90;
    Vec3 dielectric_color; ///< times its share
    Vec3 darkening;        ///< of all below the coat
    RestColors rests;      ///< times the rests of both directions
    LayerTerms at_o;       ///< of the outgoing direction
    LobeShares shares;
};

FN Vec3 multiply_colors(const Vec3 a, const Vec3 b) {
    Vec3 product = {a.x * b.x, a.y * b.y, a.z * b.z};
    return product;
}

FN Vec3 blend_from_one(const Vec3 color, const Float weight) {
    Float rest = Float(1.0f) - weight;
    Vec3 result = {rest + color.x * weight, rest + color.y * weight, rest + color.z * weight};
    return result;
}

/// A rough coat blurs what lies below (OpenPBR 1.1, "Coat": roughening).
FN Float roughen_base(const Float roughness, const LayerParameters l) {
    Float base2 = roughness * roughness;
    Float coat2 = l.coat_roughness * l.coat_roughness;
    Float sum = min(base2 * base2 + Float(2.0f) * coat2 * coat2, Float(1.0f));
    return roughness + (sqrt(sqrt(sum)) - roughness) * l.coat_weight;
}

/// `roughness`: of the base under the coat.
FN LayerTerms make_layer_terms(const LayeredSurface s, const LayerTable table, const Float roughness,
                               const Vec3 w) {
    Float one = Float(1.0f);
    Float zero = Float(0.0f);
    LayerParameters l = s.layers;
    Float cos_theta = w.z;
    LayerTerms t;
    t.fuzz = one;
    if (is_any(l.fuzz_weight > zero))
        t.fuzz = max(zero, one - l.fuzz_weight * lookup_fuzz_albedo(table, l, cos_theta));
    t.coat = one;
    t.path = one;
    if (is_any(l.coat_weight > zero)) {
        Float seen = find_seen_roughness(l.coat_roughness, l.coat_anisotropy, w);
        GgxAlbedo coat = lookup_ggx_albedo(seen, cos_theta);
        t.coat = max(zero, one - l.coat_f0 * coat.scale - l.coat_f90 * coat.bias);
        Float sine2 = max(zero, one - cos_theta * cos_theta);
        t.path = one / sqrt(max(Float(1e-4f), one - sine2 * l.coat_inverse_ior2));
    }
    GgxAlbedo base = lookup_ggx_albedo(find_seen_roughness(roughness, l.specular_anisotropy, w), cos_theta);
    t.specular = l.dielectric_f0 * base.scale + l.dielectric_f90 * base.bias;
    t.base = max(zero, one - t.specular);
    Vec2 rest = lookup_layer_rest(table, l, s.roughness, w);
    t.rest_dielectric = rest.x;
    t.rest_metal = rest.y;
    return t;
}

/// What is left of light that goes down and up through the coat.
FN Vec3 pass_coat_color(const LayerParameters l, const Float path_o, const Float path_i) {
    Float way = Float(0.0f) - path_o - path_i;
    Vec3 result = {find_power_of_two(l.coat_depth.x * way), find_power_of_two(l.coat_depth.y * way),
                   find_power_of_two(l.coat_depth.z * way)};
    return result;
}

/// Mean albedo of the base over all directions.
FN Float average_base(const Float color, const Float metal, const Float tint, const LayerParameters l) {
    Float specular = average_fresnel(l.dielectric_f0, l.dielectric_f90);
    Float dielectric = specular * tint + (Float(1.0f) - specular) * color;
    return dielectric + (metal - dielectric) * l.metallic;
}

/// Light that the coat reflects back onto the base (OpenPBR 1.1, "Coat": darkening). For `albedo` 1 it is 1.
FN Float darken_base(const Float albedo, const Float inside, const Float amount) {
    Float full = (Float(1.0f) - inside) / max(Float(1e-6f), Float(1.0f) - albedo * inside);
    return Float(1.0f) + (full - Float(1.0f)) * amount;
}

/// Drop of the F82-tint model below Schlick's Fresnel (Kutz, Hasan and Edmondson 2021, Novel aspects of the
/// Adobe Standard Material, equation 17): times mu (1 - mu)^6; its mean over the hemisphere is 1/126 of it.
FN Float find_edge(const Float f0, const Float tint) {
    Float at_edge = f0 + (Float(1.0f) - f0) * Float(0.46266436f); // (6/7)^5
    return at_edge * (Float(1.0f) - tint) * Float(17.651385f);    // 1 / (1/7 (6/7)^6)
}

FN Float average_metal(const Float f0, const Float edge) {
    return average_fresnel(f0, Float(1.0f)) - edge * Float(1.0f / 126.0f);
}

/// Lobes are drawn by their albedos, each that there is by a part in twelve at least. `metal`: of its facets.
FN LobeShares share_lobes(const LayeredSurface s, const LayerTerms o, const Float metal) {
    Float one = Float(1.0f);
    Float zero = Float(0.0f);
    LayerParameters l = s.layers;
    Float dielectric = one - l.metallic;
    Float brightness = luminance(s.base_color);
    Float below = o.fuzz * (one - l.coat_weight * (one - o.coat));
    Float fuzz = (one - o.fuzz) * luminance(l.fuzz_color);
    Float coat = o.fuzz * l.coat_weight * (one - o.coat);
    Float base = below * (metal + dielectric * luminance(l.specular_color) * o.specular);
    Float cosine = brightness * (dielectric * below * o.base + l.metallic * o.rest_metal);
    Float least = Float(0.125f) * max(fuzz + coat + base + cosine, Float(1e-6f));
    fuzz = select(l.fuzz_weight > zero, fuzz + least, zero);
    coat = select(l.coat_weight > zero, coat + least, zero);
    base = select(l.metallic > zero || l.dielectric_f90 > zero, base + least, zero);
    Float inverse = one / (fuzz + coat + base + cosine + least);
    LobeShares result = {base * inverse, coat * inverse, fuzz * inverse};
    return result;
}

/// `metal`: mean Fresnel, `average`: mean rests.
FN RestColors color_rests(const LayeredSurface s, const Vec3 metal, const Vec2 average) {
    Float one = Float(1.0f);
    Float metallic = s.layers.metallic;
    Vec3 multiple = {multiple_scattering(metal.x, one - average.y),
                     multiple_scattering(metal.y, one - average.y),
                     multiple_scattering(metal.z, one - average.y)};
    RestColors result;
    result.dielectric = s.base_color * ((one - metallic) / (Float(kPi) * max(average.x, Float(1e-6f))));
    result.metal = multiple * (metallic / (Float(kPi) * max(average.y, Float(1e-6f))));
    return result;
}

/// `wo`: the outgoing direction, above the surface.
FN LayeredBsdf make_layered_bsdf(const LayeredSurface s, const LayerTable table, const Vec3 wo) {
    Float one = Float(1.0f);
    LayerParameters l = s.layers;
    Vec3 c = s.base_color;
    LayeredBsdf b;
    b.surface = s;
    b.roughness = roughen_base(s.roughness, l);
    b.facets = make_facets(b.roughness, l.specular_anisotropy);
    b.coat_facets = make_facets(l.coat_roughness, l.coat_anisotropy);
    Vec3 edge = {find_edge(c.x, l.specular_color.x), find_edge(c.y, l.specular_color.y),
                 find_edge(c.z, l.specular_color.z)};
    Float weight = l.specular_weight * l.metallic;
    b.metal_f0 = c * weight;
    b.metal_f90 = weight;
    b.metal_edge = edge * weight;
    b.dielectric_color = l.specular_color * (one - l.metallic);
    Vec3 metal = {average_metal(c.x, edge.x) * l.specular_weight,
                  average_metal(c.y, edge.y) * l.specular_weight,
                  average_metal(c.z, edge.z) * l.specular_weight};
    // A smooth metal sends what the coat reflects back straight up again, a diffuse base all around.
    Float rough = one + (b.roughness - one) * l.metallic;
    Float inside = l.coat_f0 + (l.coat_inside - l.coat_f0) * rough;
    Vec3 darkening = {
        darken_base(average_base(c.x, metal.x, l.specular_color.x, l), inside, l.coat_darkening),
        darken_base(average_base(c.y, metal.y, l.specular_color.y, l), inside, l.coat_darkening),
        darken_base(average_base(c.z, metal.z, l.specular_color.z, l), inside, l.coat_darkening)};
    b.darkening = darkening;
    b.at_o = make_layer_terms(s, table, b.roughness, wo);
    b.rests = color_rests(s, metal, lookup_layer_average(table, l, s.roughness));
    GgxAlbedo facets = lookup_ggx_albedo(b.roughness, wo.z);
    b.shares = share_lobes(s, b.at_o, luminance(b.metal_f0) * facets.scale + b.metal_f90 * facets.bias);
    return b;
}

/// Fresnel of metal and dielectric together.
FN Vec3 layered_fresnel(const LayeredBsdf b, const Float cos_h) {
    Float m = clamp(Float(1.0f) - cos_h, Float(0.0f), Float(1.0f));
    Float m2 = m * m;
    Float m5 = m2 * m2 * m;
    LayerParameters l = b.surface.layers;
    Float dielectric = l.dielectric_f0 + (l.dielectric_f90 - l.dielectric_f0) * m5;
    Float drop = (Float(1.0f) - m) * m5 * m;
    Float zero = Float(0.0f);
    Vec3 metal = {max(zero, b.metal_f0.x + (b.metal_f90 - b.metal_f0.x) * m5 - b.metal_edge.x * drop),
                  max(zero, b.metal_f0.y + (b.metal_f90 - b.metal_f0.y) * m5 - b.metal_edge.y * drop),
                  max(zero, b.metal_f0.z + (b.metal_f90 - b.metal_f0.z) * m5 - b.metal_edge.z * drop)};
    return b.dielectric_color * dielectric + metal;
}

/// A microfacet lobe without its Fresnel: x times the cosine of the incoming direction, y its density.
FN Vec2 evaluate_facets(const Facets f, const Vec3 h, const Vec3 wo, const Vec3 wi) {
    Float lambda_o = facets_lambda(f, wo);
    Float lobe = ggx_distribution(f.alpha, h) / (Float(4.0f) * wo.z);
    Vec2 result = {lobe / (Float(1.0f) + lambda_o + facets_lambda(f, wi)), lobe / (Float(1.0f) + lambda_o)};
    return result;
}

/// Charlie: Estevez and Kulla 2017, Production Friendly Microfacet Sheen BRDF, equation 2; what its fibres
/// hide of each other after Neubelt and Pettineo 2013. Without the cosine.
FN Float evaluate_fuzz(const LayerParameters l, const Float cos_h, const Float cos_o, const Float cos_i) {
    Float sine2 = max(Float(1e-12f), Float(1.0f) - cos_h * cos_h);
    Float power = find_power_of_two(Float(0.5f) * l.fuzz_exponent * find_logarithm(sine2));
    Float distribution = (l.fuzz_exponent + Float(2.0f)) * Float(0.5f / kPi) * power;
    return l.fuzz_scale * distribution / (Float(4.0f) * (cos_o + cos_i - cos_o * cos_i));
}

/// Both directions above the surface.
FN BsdfValue evaluate_above_layers(const LayeredBsdf b, const LayerTable table, const Vec3 wo,
                                   const Vec3 wi) {
    Float one = Float(1.0f);
    Float zero = Float(0.0f);
    LayerParameters l = b.surface.layers;
    Vec3 h = normalize(wo + wi);
    Float cos_h = dot(wo, h);
    LayerTerms o = b.at_o;
    LayerTerms i = make_layer_terms(b.surface, table, b.roughness, wi);
    Vec2 facets = evaluate_facets(b.facets, h, wo, wi);
    Vec3 diffuse = evaluate_eon(b.surface.base_color, l.diffuse_roughness, wo, wi);
    Vec3 base =
        layered_fresnel(b, cos_h) * facets.x + diffuse * ((one - l.metallic) * o.base * i.base * wi.z);
    Vec3 rest = (b.rests.dielectric * (o.rest_dielectric * i.rest_dielectric) +
                 b.rests.metal * (o.rest_metal * i.rest_metal)) *
                wi.z;
    BsdfValue result;
    result.value = base;
    LobeShares shares = b.shares;
    result.pdf = shares.base * facets.y +
                 (one - shares.base - shares.coat - shares.fuzz) * cosine_hemisphere_pdf(wi.z);
    if (is_any(l.coat_weight > zero)) {
        Vec3 color = multiply_colors(pass_coat_color(l, o.path, i.path), b.darkening);
        Vec2 coat = evaluate_facets(b.coat_facets, h, wo, wi);
        Float fresnel = schlick_fresnel(make_grey(l.coat_f0), l.coat_f90, cos_h).x;
        result.value = multiply_colors(base, blend_from_one(color * (o.coat * i.coat), l.coat_weight)) +
                       make_grey(l.coat_weight * fresnel * coat.x);
        rest = multiply_colors(rest, blend_from_one(color, l.coat_weight));
        result.pdf = result.pdf + shares.coat * coat.y;
    }
    if (is_any(l.fuzz_weight > zero)) {
        Float fuzz = l.fuzz_weight * evaluate_fuzz(l, h.z, wo.z, wi.z) * wi.z;
        result.value = result.value * (o.fuzz * i.fuzz) + l.fuzz_color * fuzz;
        result.pdf = result.pdf + shares.fuzz * Float(0.5f / kPi);
    }
    result.value = result.value + rest;
    return result;
}

/// Value and density of `wi` for light leaving along `wo`; zero when either is below. Unit vectors.
FN BsdfValue evaluate_layered_bsdf(const LayeredBsdf b, const LayerTable table, const Vec3 wo,
                                   const Vec3 wi) {
    Float zero = Float(0.0f);
    Bool is_above = wo.z > zero && wi.z > zero;
    BsdfValue result;
    result.value = make_grey(zero);
    result.pdf = zero;
    if (is_any(is_above)) {
        BsdfValue above = evaluate_above_layers(b, table, wo, wi);
        result.value = select(is_above, above.value, result.value);
        result.pdf = select(is_above, above.pdf, result.pdf);
    }
    return result;
}

/// Samples an incoming direction for `wo`: `u_lobe` in [0, 1) selects the lobe, `u` the direction within it.
FN BsdfSample sample_layered_bsdf(const LayeredBsdf b, const LayerTable table, const Vec3 wo,
                                  const Float u_lobe, const Vec2 u) {
    Vec3 wi = square_to_cosine_hemisphere(u);
    Float coat_end = b.shares.base + b.shares.coat;
    Float fuzz_end = coat_end + b.shares.fuzz;
    Bool is_facet = u_lobe < coat_end;
    Bool is_fuzz = u_lobe >= coat_end && u_lobe < fuzz_end;
    if (is_any(is_facet)) {
        Vec2 alpha = select(u_lobe < b.shares.base, b.facets.alpha, b.coat_facets.alpha);
        wi = select(is_facet, sample_ggx_reflection(alpha, wo, u), wi);
    }
    if (is_any(is_fuzz)) wi = select(is_fuzz, square_to_cone(u, Float(1.0f)), wi);
    wi = normalize(wi);
    BsdfValue v = evaluate_layered_bsdf(b, table, wo, wi);
    Bool is_possible = v.pdf > Float(0.0f);
    Float share = select(is_possible, Float(1.0f) / select(is_possible, v.pdf, Float(1.0f)), Float(0.0f));
    BsdfSample result = {wi, v.value * share, v.pdf};
    return result;
}

#include "formulas/end.h"
#endif
