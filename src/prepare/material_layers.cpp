#include "prepare/material_layers.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "formulas/layered_bsdf.h"
#include "formulas/sobol.h"

namespace relief {

namespace {

constexpr uint32_t kColumns = scalar::kLayerColumnCount;
constexpr uint32_t kRows = 16;     ///< where a texture changes the roughness; else one
constexpr uint32_t kSamples = 512; ///< of each lobe
constexpr float kLeastCosine = 1e-4f;
constexpr Vec3f kWhite{1, 1, 1};

/// Fresnel's reflection at normal incidence between two indices of refraction.
float find_f0(float ratio) {
    const float root = (ratio - 1) / (ratio + 1);
    return root * root;
}

/// As in make_general_bsdf: the surface fades out together with its reflection at normal incidence.
float find_f90(float f0) { return std::min(1.0f, 50 * f0); }

uint32_t count_rows(const Material& material) { return material.roughness_texture ? kRows : 1; }

uint32_t count_entries(const Material& material) { return count_rows(material) * (kColumns + 1) + kColumns; }

/// -log2 of the square root of a colour: straight down and up again makes the colour itself.
Vec3f find_depth(const Vec3f& color) {
    const auto depth = [](float c) { return -0.5f * std::log2(std::max(c, 1e-12f)); };
    return {depth(color.x), depth(color.y), depth(color.z)};
}

/// All but fuzz_scale and first_entry.
scalar::LayerParameters make_record(const Material& material) {
    scalar::LayerParameters l{};
    l.specular_color = material.specular_color, l.specular_weight = material.specular_weight;
    l.metallic = material.metallic;
    // Under a coat the light comes from its medium (OpenPBR 1.1, "Coat": refraction).
    const float medium = 1 + material.coat_weight * (material.coat_ior - 1);
    l.dielectric_f0 = material.specular_weight * find_f0(material.ior / medium);
    l.dielectric_f90 = find_f90(l.dielectric_f0);
    l.diffuse_roughness = material.base_diffuse_roughness;
    l.coat_weight = material.coat_weight, l.coat_roughness = material.coat_roughness;
    l.coat_f0 = find_f0(material.coat_ior), l.coat_f90 = find_f90(l.coat_f0);
    l.coat_inverse_ior2 = 1 / (material.coat_ior * material.coat_ior);
    l.coat_depth = find_depth(material.coat_color);
    l.coat_darkening = material.coat_darkening;
    // What leaves a medium diffusely is what enters it, less by the solid angle (OpenPBR 1.1, "Coat":
    // darkening).
    l.coat_inside = 1 - (1 - scalar::average_fresnel(l.coat_f0, l.coat_f90)) * l.coat_inverse_ior2;
    l.fuzz_color = material.fuzz_color, l.fuzz_weight = material.fuzz_weight;
    l.fuzz_exponent = 1 / std::max(material.fuzz_roughness, 0.07f);
    l.fuzz_scale = 1;
    l.row_scale = float(count_rows(material) - 1);
    return l;
}

float column_cosine(uint32_t column) {
    const float x = float(column) / float(kColumns - 1);
    return std::max(x * x, kLeastCosine);
}

Vec3f make_direction(float cosine) { return {std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine}; }

/// Directional albedo of the fuzz, midpoint rule over cosine and angle.
float integrate_fuzz(const scalar::LayerParameters& l, float cosine) {
    constexpr int kCosines = 128, kAngles = 64;
    const Vec3f wo = make_direction(cosine);
    double sum = 0;
    for (int i = 0; i < kCosines; ++i) {
        const float z = (float(i) + 0.5f) / kCosines, sine = std::sqrt(1 - z * z);
        for (int j = 0; j < kAngles; ++j) {
            const scalar::SinCos phi = scalar::find_sin_cos(scalar::kPi * (float(j) + 0.5f) / kAngles);
            const Vec3f h = normalize(wo + Vec3f{sine * phi.cosine, sine * phi.sine, z});
            sum += double(scalar::evaluate_fuzz(l, h.z, cosine, z) * z);
        }
    }
    return float(sum * 2 * double(scalar::kPi) / (kCosines * kAngles));
}

void fill_fuzz(scalar::LayerParameters& l, Vec2f* entries) {
    float most = 1;
    for (uint32_t k = 0; k < kColumns; ++k) {
        entries[k].x = integrate_fuzz(l, column_cosine(k));
        most = std::max(most, entries[k].x);
    }
    l.fuzz_scale = 1 / most;
    for (uint32_t k = 0; k < kColumns; ++k) entries[k].x /= most;
}

/// Mean weight of directions of the lobe that `u_lobe` selects.
double average_lobe(const scalar::LayeredBsdf& bsdf, scalar::LayerTable table, const Vec3f& wo,
                    float u_lobe) {
    double sum = 0;
    for (uint32_t k = 0; k < kSamples; ++k)
        sum += double(
            scalar::sample_layered_bsdf(bsdf, table, wo, u_lobe, scalar::sobol_pair(1, k, 0)).weight.x);
    return sum / kSamples;
}

/// What all lobes of a white stack scatter once. The table holds no rests yet. Each lobe is drawn from by
/// itself, and counts by its share: which of them is drawn next adds no noise.
float measure_albedo(const scalar::LayeredSurface& white, scalar::LayerTable table, float cosine) {
    const scalar::LayeredBsdf bsdf = scalar::make_layered_bsdf(white, table, cosine);
    const Vec3f wo = make_direction(cosine);
    const scalar::LobeShares& shares = bsdf.shares;
    double sum = 0;
    float first = 0;
    for (const float end :
         {shares.base, shares.base + shares.coat, shares.base + shares.coat + shares.fuzz, 1.0f}) {
        if (end > first) sum += double(end - first) * average_lobe(bsdf, table, wo, 0.5f * (first + end));
        first = end;
    }
    return float(sum);
}

/// The surface that absorbs nothing in place of one; `metallic`: 0 or 1.
scalar::LayeredSurface whiten(const scalar::LayerParameters& layers, float roughness, float metallic) {
    scalar::LayeredSurface white{kWhite, roughness, layers};
    white.layers.specular_color = white.layers.fuzz_color = kWhite;
    white.layers.specular_weight = 1, white.layers.metallic = metallic;
    white.layers.coat_depth = {};
    return white;
}

/// 2 integral(f(x) x dx) over the cosine x of a row that is linear in the square root of x between entries.
Vec2f average_row(const Vec2f* row) {
    Vec2<double> sum{};
    const auto power = [](double x, int n) { return n == 4 ? x * x * x * x : x * x * x * x * x; };
    for (uint32_t k = 0; k + 1 < kColumns; ++k) {
        const double a = double(k) / (kColumns - 1), b = double(k + 1) / (kColumns - 1);
        const double whole = power(b, 4) - power(a, 4); // of 4 x^3
        const double rising =
            (0.8 * (power(b, 5) - power(a, 5)) - a * whole) / (b - a); // of 4 x^3 (x - a) / (b - a)
        sum.x += double(row[k].x) * (whole - rising) + double(row[k + 1].x) * rising;
        sum.y += double(row[k].y) * (whole - rising) + double(row[k + 1].y) * rising;
    }
    return {float(sum.x), float(sum.y)};
}

/// A row of rests; `block` has those of the fuzz.
void fill_row(const scalar::LayerParameters& layers, float roughness, const Vec2f* block, Vec2f* row) {
    scalar::LayerParameters alone = layers;
    alone.first_entry = 0;
    for (uint32_t k = 0; k < kColumns; ++k) {
        const float cosine = column_cosine(k);
        const auto rest = [&](float metallic) {
            return std::max(0.0f, 1 - measure_albedo(whiten(alone, roughness, metallic), {block}, cosine));
        };
        row[k] = {rest(0), rest(1)};
    }
}

/// A row of a material.
struct Row {
    uint32_t record, row;
    float roughness;
};

} // namespace

bool is_layered(const Material& material) {
    return material.base_diffuse_roughness > 0 || material.specular_weight != 1 ||
           !(material.specular_color == kWhite) || material.coat_weight > 0 || material.fuzz_weight > 0;
}

MaterialLayers make_material_layers(const std::vector<Material>& materials) {
    MaterialLayers result;
    std::vector<Row> rows;
    std::vector<uint32_t> sizes;
    for (const Material& material : materials) {
        const bool has_layers = is_layered(material);
        result.record_of_material.push_back(has_layers ? uint32_t(result.records.size()) : kNoIndex);
        if (!has_layers) continue;
        const uint32_t count = count_rows(material);
        for (uint32_t k = 0; k < count; ++k)
            rows.push_back({uint32_t(result.records.size()), k,
                            count == 1 ? material.roughness : float(k) / float(count - 1)});
        result.records.push_back(make_record(material));
        result.records.back().first_entry = uint32_t(result.entries.size());
        sizes.push_back(count_entries(material));
        result.entries.resize(result.entries.size() + sizes.back());
    }
    std::vector<Vec2f> fuzz = result.entries; // without rests, which are measured beside them
    parallel_for("fuzz", result.records.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            scalar::LayerParameters& l = result.records[k];
            const uint32_t first = l.first_entry + sizes[k] - kColumns;
            if (l.fuzz_weight > 0) fill_fuzz(l, &fuzz[first]);
            std::copy_n(&fuzz[first], kColumns, &result.entries[first]);
        }
    });
    parallel_for("layers", rows.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const scalar::LayerParameters& l = result.records[rows[k].record];
            Vec2f* const block = &result.entries[l.first_entry];
            Vec2f* const row = block + rows[k].row * kColumns;
            fill_row(l, rows[k].roughness, &fuzz[l.first_entry], row);
            block[uint32_t(l.row_scale + 1) * kColumns + rows[k].row] = average_row(row);
        }
    });
    return result;
}

} // namespace relief
