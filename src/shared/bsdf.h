// Metallic-roughness surface in the local frame (shading normal = z): a GGX lobe over a diffuse base, both
// energy conserving. Microfacets: Walter et al. 2007 with height-correlated Smith shadowing (Heitz 2014,
// Understanding the Masking-Shadowing Function). Energy lost between microfacets and the coupling of coat and
// base: Kulla and Conty 2017, Revisiting Physically Based Shading; both are reciprocal, and a white surface
// returns all light.
#ifndef RELIEF_BSDF_H
#ifndef __cplusplus
#define RELIEF_BSDF_H
#endif

struct BsdfParameters {
    Vec3 base_color; ///< reflectance of the diffuse base; of the metal at normal incidence
    float roughness; ///< [0, 1]; alpha is its square, at least kMinAlpha
    float metallic;  ///< [0, 1]
    float ior;       ///< of the dielectric coat, >= 1; 1: no coat
};

/// Made for one outgoing direction.
struct Bsdf {
    Vec3 f0;   ///< Schlick's Fresnel at normal incidence
    float f90; ///< and at grazing incidence
    float alpha, roughness;
    Vec3 multiple; ///< of light scattered more than once: times (1 - E(o)) (1 - E(i))
    Vec3 diffuse;  ///< of the base: times (1 - C(o)) (1 - C(i)), C the albedo of the dielectric coat
    float coat_f0, coat_f90, coat_multiple;
    float escape_multiple;      ///< 1 - E(o)
    float escape_coat;          ///< 1 - C(o)
    float specular_probability; ///< of sampling the microfacet lobe
};

/// Density is per solid angle.
struct BsdfValue {
    Vec3 value; ///< BSDF times the cosine of the incoming direction
    float pdf;
};

struct BsdfSample {
    Vec3 direction;
    Vec3 weight; ///< value / pdf; zero for a direction below the surface
    float pdf;
};

const float kMinAlpha = 1e-3f;

FN float luminance(Vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Part of the light that leaves after several bounces between microfacets, of Fresnel average f (Hill 2018,
/// A Multi-Faceted Exploration, part 2): f^2 E / (1 - f (1 - E)).
FN float multiple_scattering(float f, float average_albedo) {
    return f * f * average_albedo / (1.0f - f * (1.0f - average_albedo));
}

/// Mean of Schlick's Fresnel over the cosine-weighted hemisphere.
FN float average_fresnel(float f0, float f90) { return f0 + (f90 - f0) * (1.0f / 21.0f); }

/// Albedo of the dielectric coat, light scattered several times included.
FN float coat_albedo(Bsdf b, GgxAlbedo e) {
    return b.coat_f0 * e.scale + b.coat_f90 * e.bias + b.coat_multiple * (1.0f - e.scale - e.bias);
}

/// That of a material without coat or metal, whatever the outgoing direction: what make_general_bsdf gives.
FN Bsdf make_diffuse_bsdf(BsdfParameters p) {
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    Bsdf b;
    b.f0 = zero;
    b.f90 = 0.0f;
    b.roughness = p.roughness;
    b.alpha = max(p.roughness * p.roughness, kMinAlpha);
    b.multiple = zero;
    b.diffuse = p.base_color * (1.0f / kPi);
    b.coat_f0 = 0.0f;
    b.coat_f90 = 0.0f;
    b.coat_multiple = 0.0f;
    b.escape_multiple = 0.0f;
    b.escape_coat = 1.0f;
    b.specular_probability = 0.0f;
    return b;
}

/// No light but that of the diffuse base, unattenuated.
FN bool is_diffuse(Bsdf b) { return b.f90 == 0.0f; }

FN Bsdf make_general_bsdf(BsdfParameters p, float cos_o) {
    float dielectric = 1.0f - p.metallic;
    float root = (p.ior - 1.0f) / (p.ior + 1.0f);
    float coat_f0 = root * root;
    // Below 2 % at normal incidence the coat fades as a whole, to nothing at ior 1.
    float coat_f90 = min(1.0f, 50.0f * coat_f0);
    GgxAlbedo average = lookup_ggx_average(p.roughness);
    GgxAlbedo at_o = lookup_ggx_albedo(p.roughness, cos_o);
    float e_average = average.scale + average.bias;
    float e_o = at_o.scale + at_o.bias;
    Bsdf b;
    b.f0 = p.base_color * p.metallic;
    b.f0.x += dielectric * coat_f0;
    b.f0.y += dielectric * coat_f0;
    b.f0.z += dielectric * coat_f0;
    b.f90 = p.metallic + dielectric * coat_f90;
    b.roughness = p.roughness;
    b.alpha = max(p.roughness * p.roughness, kMinAlpha);
    b.coat_f0 = coat_f0;
    b.coat_f90 = coat_f90;
    b.coat_multiple = multiple_scattering(average_fresnel(coat_f0, coat_f90), e_average);
    float from_coat = dielectric * b.coat_multiple;
    Vec3 f_multiple = {
        p.metallic * multiple_scattering(average_fresnel(p.base_color.x, 1.0f), e_average) + from_coat,
        p.metallic * multiple_scattering(average_fresnel(p.base_color.y, 1.0f), e_average) + from_coat,
        p.metallic * multiple_scattering(average_fresnel(p.base_color.z, 1.0f), e_average) + from_coat};
    b.escape_multiple = max(0.0f, 1.0f - e_o);
    b.escape_coat = max(0.0f, 1.0f - coat_albedo(b, at_o));
    b.multiple = f_multiple * (1.0f / (kPi * max(1.0f - e_average, 1e-6f)));
    b.diffuse = p.base_color * (dielectric / (kPi * max(1.0f - coat_albedo(b, average), 1e-6f)));
    float specular = luminance(b.f0) * at_o.scale + b.f90 * at_o.bias;
    float cosine =
        luminance(f_multiple) * b.escape_multiple + dielectric * luminance(p.base_color) * b.escape_coat;
    // At least a fifth for the sharp lobe: its Fresnel factor can be far above its mean.
    b.specular_probability = specular > 0.0f ? clamp(specular / (specular + cosine), 0.2f, 1.0f) : 0.0f;
    return b;
}

/// `cos_o`: cosine of the outgoing direction, > 0.
FN Bsdf make_bsdf(BsdfParameters p, float cos_o) {
    if (p.metallic == 0.0f && p.ior == 1.0f) return make_diffuse_bsdf(p);
    return make_general_bsdf(p, cos_o);
}

/// Smith's lambda of GGX; cos_theta > 0.
FN float ggx_lambda(float alpha, float cos_theta) {
    float cos2 = cos_theta * cos_theta;
    float tan2 = max(0.0f, 1.0f - cos2) / cos2;
    return 0.5f * (sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

/// Normal distribution; h a unit vector. Written without 1 - h.z^2, which cancels for smooth surfaces.
FN float ggx_distribution(float alpha, Vec3 h) {
    float x = h.x / alpha;
    float y = h.y / alpha;
    float k = x * x + y * y + h.z * h.z;
    return 1.0f / (kPi * alpha * alpha * k * k);
}

FN Vec3 schlick_fresnel(Vec3 f0, float f90, float cos_h) {
    float m = clamp(1.0f - cos_h, 0.0f, 1.0f);
    float m5 = m * m * m * m * m;
    Vec3 result = {f0.x + (f90 - f0.x) * m5, f0.y + (f90 - f0.y) * m5, f0.z + (f90 - f0.z) * m5};
    return result;
}

/// Value and density of `wi` for light that leaves along `wo`; zero when either is below the surface. Unit
/// vectors.
FN BsdfValue evaluate_bsdf(Bsdf b, Vec3 wo, Vec3 wi) {
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    BsdfValue result = {zero, 0.0f};
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return result;
    if (is_diffuse(b)) {
        result.value = b.diffuse * wi.z;
        result.pdf = cosine_hemisphere_pdf(wi.z);
        return result;
    }
    Vec3 h = normalize(wo + wi);
    float lambda_o = ggx_lambda(b.alpha, wo.z);
    float lambda_i = ggx_lambda(b.alpha, wi.z);
    float lobe = ggx_distribution(b.alpha, h) / (4.0f * wo.z);
    Vec3 specular = schlick_fresnel(b.f0, b.f90, dot(wo, h)) * (lobe / (1.0f + lambda_o + lambda_i));
    GgxAlbedo at_i = lookup_ggx_albedo(b.roughness, wi.z);
    float multiple = b.escape_multiple * max(0.0f, 1.0f - at_i.scale - at_i.bias) * wi.z;
    float diffuse = b.escape_coat * max(0.0f, 1.0f - coat_albedo(b, at_i)) * wi.z;
    result.value = specular + b.multiple * multiple + b.diffuse * diffuse;
    result.pdf = b.specular_probability * lobe / (1.0f + lambda_o) +
                 (1.0f - b.specular_probability) * cosine_hemisphere_pdf(wi.z);
    return result;
}

/// Direction that `wo` is mirrored to by a microfacet normal drawn from those visible (Dupuy and Benyoub
/// 2023, Sampling Visible GGX Normals with Spherical Caps).
FN Vec3 sample_ggx_reflection(float alpha, Vec3 wo, Vec2 u) {
    Vec3 stretched = {alpha * wo.x, alpha * wo.y, wo.z};
    Vec3 o = normalize(stretched);
    float phi = 2.0f * kPi * u.x;
    float z = (1.0f - u.y) * (1.0f + o.z) - o.z;
    float sin_theta = sqrt(max(0.0f, 1.0f - z * z));
    Vec3 unstretched = {alpha * (sin_theta * cos(phi) + o.x), alpha * (sin_theta * sin(phi) + o.y), z + o.z};
    Vec3 h = normalize(unstretched);
    return h * (2.0f * dot(wo, h)) - wo;
}

/// Draws an incoming direction for `wo`: `u_lobe` in [0, 1) picks the lobe, `u` the direction within it.
FN BsdfSample sample_bsdf(Bsdf b, Vec3 wo, float u_lobe, Vec2 u) {
    Vec3 wi;
    if (u_lobe < b.specular_probability)
        wi = normalize(sample_ggx_reflection(b.alpha, wo, u));
    else
        wi = normalize(square_to_cosine_hemisphere(u));
    BsdfValue v = evaluate_bsdf(b, wo, wi);
    BsdfSample result = {wi, v.value * (v.pdf > 0.0f ? 1.0f / v.pdf : 0.0f), v.pdf};
    return result;
}

#endif
