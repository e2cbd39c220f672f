#include <vector>

#include <gtest/gtest.h>

#include "formulas/bsdf.h"
#include "formulas/ggx_albedo.h"
#include "formulas/sobol.h"
#include "hemisphere.h"
#include "statistics.h"
#include "support/net_points.h"

namespace relief {
namespace {

using scalar::Bsdf;
using scalar::BsdfParameters;

const float kRoughnesses[] = {0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f};
const float kCosines[] = {0.02f, 0.1f, 0.3f, 0.6f, 0.95f};

/// What the table's spacing costs: more at the horizon, where narrow lobes change fast.
double tolerance(float cosine) { return cosine < 0.05f ? 0.02 : 0.01; }

/// Mean of the sample weights: the directional albedo, from a stratified set.
Vec3f estimate_albedo(const BsdfParameters& parameters, float cosine) {
    const Vec3f wo = direction(cosine, 0.3f);
    const Bsdf bsdf = scalar::make_bsdf(parameters, cosine);
    Vec3<double> sum{};
    const uint32_t n = 1u << 17;
    for (uint32_t k = 0; k < n; ++k) {
        const test::NetPoint u = test::find_net_point(k, n);
        const Vec3f w = scalar::sample_bsdf(bsdf, wo, u.x, u.yz).weight;
        sum.x += w.x, sum.y += w.y, sum.z += w.z;
    }
    return {float(sum.x / n), float(sum.y / n), float(sum.z / n)};
}

TEST(Bsdf, returns_all_light_from_a_white_metal_of_any_roughness) {
    for (float roughness : {0.0f, 0.03f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f})
        for (float cosine : kCosines)
            EXPECT_NEAR(estimate_albedo({{1, 1, 1}, roughness, 1, 1.5f}, cosine).x, 1, tolerance(cosine))
                << "roughness " << roughness << " cosine " << cosine;
}

TEST(Bsdf, returns_all_light_from_a_white_base_under_a_coat) {
    for (float ior : {1.0f, 1.2f, 1.5f, 2.0f})
        for (float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.77f, 1.0f})
            for (float cosine : kCosines)
                EXPECT_NEAR(estimate_albedo({{1, 1, 1}, roughness, 0, ior}, cosine).x, 1, tolerance(cosine))
                    << "ior " << ior << " roughness " << roughness << " cosine " << cosine;
}

TEST(Bsdf, never_gains_energy) {
    for (float metallic : {0.0f, 0.4f, 1.0f})
        for (float roughness : kRoughnesses)
            for (float cosine : kCosines) {
                const Vec3f albedo = estimate_albedo({{0.9f, 0.5f, 0.0f}, roughness, metallic, 1.5f}, cosine);
                EXPECT_LT(albedo.x, 1.0f);
                EXPECT_LE(albedo.y, albedo.x);
                EXPECT_GE(albedo.z, 0);
            }
}

TEST(Bsdf, agrees_with_its_integral_by_quadrature) {
    for (float roughness : {0.35f, 0.6f, 1.0f})
        for (float metallic : {0.0f, 0.5f, 1.0f}) {
            const BsdfParameters parameters{{0.8f, 0.6f, 0.3f}, roughness, metallic, 1.5f};
            const Vec3f wo = direction(0.6f, 0);
            const Bsdf bsdf = scalar::make_bsdf(parameters, wo.z);
            const double integral = integrate_hemisphere(
                [&](const Vec3f& wi) { return scalar::evaluate_bsdf(bsdf, wo, wi).value.y; }, 200, 200);
            EXPECT_NEAR(integral, estimate_albedo(parameters, wo.z).y, 4e-3);
        }
}

TEST(Bsdf, is_reciprocal) {
    Random random(5);
    for (int k = 0; k < 2000; ++k) {
        const Vec3f color{random.next(), random.next(), random.next()};
        const BsdfParameters parameters{color, random.next(), random.next(), 1 + random.next()};
        const Vec3f a = direction(0.05f + 0.9f * random.next(), 6 * random.next());
        const Vec3f b = direction(0.05f + 0.9f * random.next(), 6 * random.next());
        const Vec3f ab = scalar::evaluate_bsdf(scalar::make_bsdf(parameters, a.z), a, b).value * (1 / b.z);
        const Vec3f ba = scalar::evaluate_bsdf(scalar::make_bsdf(parameters, b.z), b, a).value * (1 / a.z);
        ASSERT_NEAR(ab.x, ba.x, 2e-4 * (ab.x + 1e-3));
        ASSERT_NEAR(ab.z, ba.z, 2e-4 * (ab.z + 1e-3));
    }
}

TEST(Bsdf, has_a_density_that_sums_up_to_the_directions_above_the_surface) {
    for (float roughness : {0.35f, 0.5f, 0.75f, 1.0f})
        for (float metallic : {0.0f, 1.0f})
            for (float cosine : {0.3f, 0.9f}) {
                const Vec3f wo = direction(cosine, 1);
                const Bsdf bsdf = scalar::make_bsdf({{0.7f, 0.7f, 0.7f}, roughness, metallic, 1.5f}, cosine);
                const double integral = integrate_hemisphere(
                    [&](const Vec3f& wi) { return scalar::evaluate_bsdf(bsdf, wo, wi).pdf; }, 300, 300);
                int above = 0;
                const uint32_t n = 1u << 14;
                for (uint32_t k = 0; k < n; ++k)
                    above += scalar::sample_bsdf(bsdf, wo, scalar::sobol_pair(3, k, 0).x,
                                                 scalar::sobol_pair(3, k, 1))
                                 .direction.z > 0;
                EXPECT_NEAR(integral, double(above) / n, 6e-3)
                    << roughness << ' ' << metallic << ' ' << cosine;
            }
}

TEST(Bsdf, draws_directions_as_its_density_says) {
    const HemisphereCells cells{.fine = 12};
    for (float roughness : {0.4f, 0.8f})
        for (float metallic : {0.0f, 1.0f}) {
            const Vec3f wo = direction(0.5f, 0.7f);
            const Bsdf bsdf = scalar::make_bsdf({{0.6f, 0.6f, 0.6f}, roughness, metallic, 1.5f}, wo.z);
            Random random(6);
            const auto draw = [&] {
                const float lobe = random.next();
                return scalar::sample_bsdf(bsdf, wo, lobe, random.next_pair()).direction;
            };
            const auto get_density = [&](const Vec3f& wi) { return scalar::evaluate_bsdf(bsdf, wo, wi).pdf; };
            EXPECT_LT(measure_chi2(cells, draw, get_density), chi_square_limit(cells.count() - 1))
                << roughness << ' ' << metallic;
        }
}

TEST(Bsdf, gives_weights_that_are_value_over_density) {
    Random random(7);
    for (int k = 0; k < 5000; ++k) {
        const float cosine = 0.01f + 0.99f * random.next();
        const Vec3f wo = normalize(direction(cosine, 2));
        const Bsdf bsdf = scalar::make_bsdf({{0.9f, 0.5f, 0.2f}, random.next(), random.next(), 1.5f}, wo.z);
        const float lobe = random.next();
        const auto drawn = scalar::sample_bsdf(bsdf, wo, lobe, random.next_pair());
        const auto value = scalar::evaluate_bsdf(bsdf, wo, drawn.direction);
        ASSERT_FLOAT_EQ(drawn.pdf, value.pdf);
        ASSERT_NEAR(drawn.weight.x * drawn.pdf, value.value.x, 1e-4f * (value.value.x + 1e-6f));
        ASSERT_LT(drawn.weight.x, 6); // a smooth estimator: nothing that could become a firefly
    }
}

TEST(Bsdf, is_lambert_without_coat_and_metal) {
    const Bsdf bsdf = scalar::make_bsdf({{0.5f, 0.5f, 0.5f}, 0.4f, 0, 1.0f}, 0.8f);
    const auto value = scalar::evaluate_bsdf(bsdf, direction(0.8f, 0), direction(0.5f, 2));
    EXPECT_NEAR(value.value.x, 0.5 / std::numbers::pi * 0.5, 1e-6);
    EXPECT_NEAR(value.pdf, 0.5 / std::numbers::pi, 1e-6);
}

TEST(Bsdf, has_a_short_way_without_coat_and_metal_that_gives_the_same_bits) {
    for (const float roughness : {0.0f, 0.3f, 1.0f})
        for (const float cos_o : {0.01f, 0.5f, 1.0f}) {
            const BsdfParameters p{{0.8f, 0.3f, 0.07f}, roughness, 0, 1};
            const Bsdf a = make_bsdf(p, cos_o), b = make_general_bsdf(p, cos_o);
            EXPECT_TRUE(is_diffuse(a) && is_diffuse(b));
            EXPECT_EQ(a.diffuse, b.diffuse);
            EXPECT_EQ(a.f0, b.f0);
            EXPECT_EQ(a.multiple, b.multiple);
            EXPECT_EQ(a.escape_coat, b.escape_coat);
            EXPECT_EQ(a.coat_multiple, b.coat_multiple);
            EXPECT_EQ(a.specular_probability, b.specular_probability);
        }
}

TEST(Bsdf, mirrors_a_smooth_metal) {
    const Vec3f wo = direction(0.5f, 0);
    const Bsdf bsdf = scalar::make_bsdf({{1, 1, 1}, 0, 1, 1.5f}, 0.5f);
    Random random(8);
    for (int k = 0; k < 100; ++k) {
        // The heavy tail of GGX is cut off: the middle 98 % of the lobe.
        const Vec2f u{random.next(), 0.01f + 0.98f * random.next()};
        const auto drawn = scalar::sample_bsdf(bsdf, wo, 0, u);
        ASSERT_LT(length(drawn.direction - Vec3f{-wo.x, -wo.y, wo.z}), 0.05f);
    }
}

TEST(GgxAlbedo, agrees_with_the_lobe_that_it_tabulates) {
    for (float roughness : kRoughnesses)
        for (float cosine : kCosines) {
            // A lobe with f0 = 1 = f90 and no compensation: E = scale + bias.
            Bsdf bsdf = scalar::make_bsdf({{1, 1, 1}, roughness, 1, 1.5f}, cosine);
            bsdf.multiple = {0, 0, 0};
            bsdf.specular_probability = 1;
            const Vec3f wo = direction(cosine, 0);
            double sum = 0;
            const uint32_t n = 1u << 13;
            for (uint32_t k = 0; k < n; ++k)
                sum += scalar::sample_bsdf(bsdf, wo, 0, scalar::sobol_pair(11, k, 1)).weight.x;
            const auto table = scalar::lookup_ggx_albedo(roughness, cosine);
            EXPECT_NEAR(table.scale + table.bias, sum / n, tolerance(cosine)) << roughness << ' ' << cosine;
        }
}

} // namespace
} // namespace relief
