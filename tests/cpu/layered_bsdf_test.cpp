// Layered materials with the tables that the engines read: energy, reciprocity, densities.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "formulas/hemisphere.h"
#include "formulas/sobol.h"
#include "formulas/statistics.h"
#include "support/layered_material.h"

namespace relief {
namespace {

const float kCosines[] = {0.02f, 0.1f, 0.3f, 0.6f, 0.95f};

Material make_white() {
    Material material;
    material.base_color = {1, 1, 1};
    return material;
}

/// Of numbers that have layers, each lobe there or not; every second one in white.
Material make_random(Random& random) {
    const bool is_white = random.next() < 0.5f;
    const auto color = [&] {
        const Vec3f drawn{random.next(), random.next(), random.next()};
        return is_white ? Vec3f{1, 1, 1} : drawn;
    };
    const auto sometimes = [&](float value) { return random.next() < 0.5f ? value : 0.0f; };
    Material m;
    m.base_color = color(), m.base_weight = is_white ? 1 : random.next();
    m.roughness = random.next(), m.ior = 1 + random.next();
    m.metallic = random.next() < 0.3f ? 1 : sometimes(random.next());
    m.base_diffuse_roughness = sometimes(random.next());
    m.specular_weight = 0.999f * random.next(), m.specular_color = color();
    m.coat_weight = sometimes(random.next()), m.coat_color = color(), m.coat_roughness = random.next();
    m.coat_ior = 1 + random.next(), m.coat_darkening = random.next();
    m.fuzz_weight = sometimes(random.next()), m.fuzz_color = color(), m.fuzz_roughness = random.next();
    return m;
}

/// One material for each lobe, the others away or weak.
std::vector<Material> make_lobes() {
    std::vector<Material> lobes(5, make_white());
    for (Material& lobe : lobes) lobe.ior = 1, lobe.base_color = {0.7f, 0.5f, 0.3f};
    lobes[0].base_diffuse_roughness = 1;
    lobes[1].metallic = 1, lobes[1].roughness = 0.5f, lobes[1].specular_color = {0.9f, 0.5f, 0.2f};
    lobes[2].ior = 1.5f, lobes[2].specular_weight = 0.8f, lobes[2].roughness = 0.6f;
    lobes[3].coat_weight = 1, lobes[3].coat_roughness = 0.4f, lobes[3].coat_color = {0.9f, 0.3f, 0.1f};
    lobes[4].fuzz_weight = 1, lobes[4].fuzz_roughness = 0.4f;
    return lobes;
}

TEST(LayeredBsdf, returns_all_light_from_a_white_stack) {
    for (const float metallic : {0.0f, 0.4f, 1.0f})
        for (const float roughness : {0.0f, 0.3f, 1.0f})
            for (const float coat : {0.0f, 0.5f, 1.0f})
                for (const float fuzz : {0.0f, 1.0f}) {
                    Material white = make_white();
                    white.metallic = metallic, white.roughness = roughness;
                    white.base_diffuse_roughness = roughness, white.specular_weight = metallic > 0 ? 1 : 0.7f;
                    white.coat_weight = coat, white.coat_roughness = 0.5f * (1 - roughness);
                    white.fuzz_weight = fuzz, white.fuzz_roughness = 0.3f + 0.5f * roughness;
                    if (!is_layered(white)) continue;
                    const Layered layered(white);
                    for (const float cosine : kCosines)
                        EXPECT_NEAR(layered.estimate_albedo(cosine).x, 1, cosine < 0.05f ? 0.02 : 0.01)
                            << "metallic " << metallic << " roughness " << roughness << " coat " << coat
                            << " fuzz " << fuzz << " cosine " << cosine;
                }
}

TEST(LayeredBsdf, of_any_numbers_gains_no_energy_is_reciprocal_and_has_a_density) {
    Random random(3);
    double most = 0;
    for (int k = 0; k < 200; ++k) {
        const Material material = make_random(random);
        const Layered layered(material);
        for (const float cosine : {0.1f, 0.7f}) {
            const Vec3f albedo = layered.estimate_albedo(cosine, 1u << 12);
            most = std::max({most, double(albedo.x), double(albedo.y), double(albedo.z)});
            EXPECT_LT(std::max({albedo.x, albedo.y, albedo.z}), 1.01f) << k << ' ' << cosine;
            EXPECT_GE(std::min({albedo.x, albedo.y, albedo.z}), 0) << k;
        }
        for (int n = 0; n < 20; ++n) {
            const Vec3f a = direction(0.02f + 0.95f * random.next(), 6 * random.next());
            const Vec3f b = direction(0.02f + 0.95f * random.next(), 6 * random.next());
            const Vec3f ab = layered.evaluate(a, b).value * (1 / b.z);
            const Vec3f ba = layered.evaluate(b, a).value * (1 / a.z);
            ASSERT_NEAR(ab.x, ba.x, 3e-4 * (double(ab.x) + 1e-3)) << k;
            ASSERT_NEAR(ab.z, ba.z, 3e-4 * (double(ab.z) + 1e-3)) << k;
        }
        if (std::min(material.roughness, material.coat_roughness) < 0.35f) continue;
        const Vec3f wo = direction(0.6f, 1);
        const scalar::LayeredBsdf bsdf = layered.make(wo);
        const double integral =
            integrate_hemisphere([&](const Vec3f& wi) { return layered.evaluate(wo, wi).pdf; }, 100, 100);
        int above = 0;
        const uint32_t n = 1u << 14;
        for (uint32_t i = 0; i < n; ++i)
            above += layered.sample(bsdf, wo, scalar::sobol_pair(3, i, 0).x, scalar::sobol_pair(3, i, 1))
                         .direction.z > 0;
        EXPECT_NEAR(integral, double(above) / n, 8e-3) << k;
    }
    EXPECT_GT(most, 0.98); // white enough that a gain would show
}

TEST(LayeredBsdf, draws_directions_of_each_lobe_as_its_density_says) {
    const std::vector<Material> lobes = make_lobes();
    const Vec3f wo = direction(0.5f, 0.7f);
    const HemisphereCells cells;
    for (size_t k = 0; k < lobes.size(); ++k) {
        const Layered layered(lobes[k]);
        const scalar::LayeredBsdf bsdf = layered.make(wo);
        Random random(6);
        const auto draw = [&] {
            const float lobe = random.next();
            return layered.sample(bsdf, wo, lobe, random.next_pair()).direction;
        };
        const auto get_density = [&](const Vec3f& wi) { return layered.evaluate(wo, wi).pdf; };
        EXPECT_LT(measure_chi2(cells, draw, get_density), chi_square_limit(cells.count() - 1))
            << "lobe " << k;
    }
}

TEST(LayeredBsdf, agrees_with_its_integral_by_quadrature) {
    for (const Material& lobe : make_lobes()) {
        const Layered layered(lobe);
        const Vec3f wo = direction(0.6f, 0);
        const double integral =
            integrate_hemisphere([&](const Vec3f& wi) { return layered.evaluate(wo, wi).value.y; }, 200, 200);
        EXPECT_NEAR(integral, layered.estimate_albedo(wo.z).y, 4e-3);
    }
}

TEST(LayeredBsdf, gives_weights_that_are_value_over_density) {
    Random random(7);
    for (int k = 0; k < 40; ++k) {
        const Layered layered(make_random(random));
        for (int n = 0; n < 100; ++n) {
            const Vec3f wo = normalize(direction(0.02f + 0.97f * random.next(), 2));
            const scalar::LayeredBsdf bsdf = layered.make(wo);
            const float lobe = random.next();
            const auto drawn = layered.sample(bsdf, wo, lobe, random.next_pair());
            const auto value = layered.evaluate(wo, drawn.direction);
            ASSERT_FLOAT_EQ(drawn.pdf, value.pdf);
            ASSERT_NEAR(drawn.weight.x * drawn.pdf, value.value.x, 1e-4f * (value.value.x + 1e-6f));
            ASSERT_LT(drawn.weight.x, 8); // nothing that could become a firefly
        }
    }
}

TEST(LayeredBsdf, comes_close_to_the_plain_material_where_its_layers_vanish) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.2f, 0.6f, 1.0f}) {
            Material material = make_white();
            material.base_color = {0.8f, 0.4f, 0.1f};
            material.metallic = metallic, material.roughness = roughness, material.coat_weight = 1e-6f;
            const Layered layered(material);
            const scalar::BsdfParameters plain{material.base_color, roughness, metallic, material.ior};
            for (const float cosine : {0.2f, 0.8f}) {
                const Vec3f wo = direction(cosine, 0), wi = direction(0.5f, 2.5f);
                const Vec3f a = layered.evaluate(wo, wi).value;
                const Vec3f b = scalar::evaluate_bsdf(scalar::make_bsdf(plain, wo.z), wo, wi).value;
                EXPECT_NEAR(a.x, b.x, 0.02 * double(b.x) + 1e-3) << metallic << ' ' << roughness;
                EXPECT_NEAR(a.z, b.z, 0.02 * double(b.z) + 1e-3) << metallic << ' ' << roughness;
            }
        }
}

TEST(LayeredBsdf, of_a_coat_tints_and_darkens_what_lies_below) {
    Material grey = make_white();
    grey.base_color = {0.5f, 0.5f, 0.5f};
    const auto albedo = [&](float darkening, const Vec3f& color) {
        Material m = grey;
        m.coat_weight = 1, m.coat_darkening = darkening, m.coat_color = color;
        return Layered(m).estimate_albedo(0.9f);
    };
    const Vec3f clear = albedo(0, {1, 1, 1}), dark = albedo(1, {1, 1, 1}),
                red = albedo(0, {0.8f, 0.2f, 0.1f});
    EXPECT_NEAR(clear.x, 0.52, 0.02);
    EXPECT_LT(dark.x, 0.8 * double(clear.x)); // (1 - K) / (1 - 0.5 K) with K 0.64
    EXPECT_GT(dark.x, 0.4 * double(clear.x));
    EXPECT_LT(red.x, clear.x);
    EXPECT_LT(red.z, red.y);
    EXPECT_LT(red.y, red.x);
}

TEST(LayeredBsdf, of_a_metal_takes_the_edge_color_at_82_degrees) {
    const float f0 = 0.9f, tint = 0.5f, edge = scalar::find_edge(f0, tint);
    const float m = 6.0f / 7.0f;
    const auto fresnel = [&](float x) {
        return f0 + (1 - f0) * std::pow(x, 5.0f) - edge * (1 - x) * std::pow(x, 6.0f);
    };
    EXPECT_NEAR(fresnel(m), tint * (f0 + (1 - f0) * std::pow(m, 5.0f)), 1e-5);
    EXPECT_NEAR(fresnel(1), 1, 1e-6);
    double mean = 0;
    for (int k = 0; k < 10000; ++k) {
        const double c = (k + 0.5) / 10000;
        mean += 2 * c * double(fresnel(float(1 - c))) / 10000;
    }
    EXPECT_NEAR(scalar::average_metal(f0, edge), mean, 1e-4);
}

TEST(LayeredBsdf, needs_layers_where_a_number_says_so) {
    const auto is_changed = [](const auto& change) {
        Material material;
        change(material);
        return is_layered(material);
    };
    EXPECT_FALSE(is_changed([](Material& m) { m.metallic = 1, m.roughness = 0.1f, m.ior = 2; }));
    EXPECT_FALSE(is_changed([](Material& m) { m.coat_color = {0, 0, 0}, m.fuzz_roughness = 1; }));
    EXPECT_FALSE(is_changed([](Material& m) { m.base_weight = 0.5f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.base_diffuse_roughness = 0.1f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.specular_weight = 0.9f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.specular_color.y = 0.9f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.coat_weight = 0.1f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.fuzz_weight = 0.1f; }));
    EXPECT_TRUE(is_changed([](Material& m) { m.specular_roughness_anisotropy = 0.1f; }));
    EXPECT_FALSE(is_changed([](Material& m) { m.coat_roughness_anisotropy = 1; }));
    EXPECT_FALSE(
        is_changed([](Material& m) { m.specular_roughness_anisotropy = 1, m.transmission_weight = 1; }));
    EXPECT_TRUE(make_material_layers({Material{}}).empty());
}

TEST(Eon, reflects_all_light_of_a_white_surface_and_is_lambert_without_roughness) {
    for (const float roughness : {0.0f, 0.5f, 1.0f})
        for (const float cosine : kCosines) {
            const Vec3f wo = direction(cosine, 0);
            const double integral = integrate_hemisphere(
                [&](const Vec3f& wi) {
                    return scalar::evaluate_eon({1, 1, 1}, roughness, wo, wi).x * wi.z;
                },
                300, 300);
            EXPECT_NEAR(integral, 1, 2e-3) << roughness << ' ' << cosine;
        }
    const Vec3f lambert = scalar::evaluate_eon({0.5f, 0.2f, 0}, 0, direction(0.3f, 0), direction(0.6f, 2));
    EXPECT_FLOAT_EQ(lambert.x, 0.5f / std::numbers::pi_v<float>);
    EXPECT_FLOAT_EQ(lambert.y, 0.2f / std::numbers::pi_v<float>);
}

TEST(Power, agrees_with_the_library_of_mathematics) {
    for (float x = -126; x <= 126; x += 0.37f)
        EXPECT_NEAR(scalar::find_power_of_two(x) / std::exp2(double(x)), 1, 4e-7) << x;
    for (float x = 1e-12f; x < 1e6f; x *= 1.37f)
        EXPECT_NEAR(scalar::find_logarithm(x), std::log2(double(x)),
                    3e-7 * (1 + std::abs(std::log2(double(x)))))
            << x;
}

} // namespace
} // namespace relief
