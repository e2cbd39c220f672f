// Facets of two widths: normalised, drawn as their density says, and those of one width where both are equal.
#include <bit>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "formulas/basis.h"
#include "formulas/facets.h"
#include "hemisphere.h"
#include "statistics.h"

namespace relief {
namespace {

using scalar::Facets;

TEST(Facets, have_the_widths_of_open_pbr) {
    for (const float roughness : {0.2f, 0.7f, 1.0f})
        for (const float anisotropy : {0.1f, 0.5f, 0.95f}) {
            const Facets f = scalar::make_facets(roughness, anisotropy);
            const double alpha = std::pow(double(roughness), 2), x = double(f.alpha.x), y = double(f.alpha.y);
            EXPECT_TRUE(f.is_stretched);
            EXPECT_NEAR(y, (1 - double(anisotropy)) * x, 1e-6);
            EXPECT_NEAR(x * x + y * y, 2 * alpha * alpha, 1e-6);
        }
    EXPECT_EQ(scalar::make_facets(0, 0.5f).alpha, (Vec2f{scalar::kMinAlpha, scalar::kMinAlpha}));
    EXPECT_EQ(scalar::make_facets(0.5f, 1).alpha.y, scalar::kMinAlpha);
}

TEST(Facets, of_no_anisotropy_have_the_bits_of_one_width) {
    Random random(1);
    for (int k = 0; k < 1000; ++k) {
        const float roughness = random.next(), alpha = scalar::find_alpha(roughness);
        const Facets f = scalar::make_facets(roughness, 0);
        const Vec3f w = direction(0.01f + 0.98f * random.next(), 6 * random.next());
        ASSERT_FALSE(f.is_stretched);
        ASSERT_EQ(f.alpha, (Vec2f{alpha, alpha}));
        ASSERT_EQ(std::bit_cast<uint32_t>(scalar::facets_lambda(f, w)),
                  std::bit_cast<uint32_t>(scalar::ggx_lambda(alpha, w.z)));
        ASSERT_EQ(scalar::find_seen_roughness(roughness, 0, w), roughness);
    }
}

TEST(Facets, cover_the_surface_once_as_seen_from_anywhere) {
    for (const float anisotropy : {0.0f, 0.4f, 0.8f})
        for (const float azimuth : {0.0f, 0.8f, 1.57f})
            for (const float cosine : {0.2f, 0.6f, 1.0f}) {
                const Facets f = scalar::make_facets(0.7f, anisotropy);
                const Vec3f w = direction(cosine, azimuth);
                const double area = integrate_hemisphere(
                    [&](const Vec3f& h) { return double(scalar::ggx_distribution(f.alpha, h) * h.z); }, 400,
                    400);
                const double seen = integrate_hemisphere(
                    [&](const Vec3f& h) {
                        return double(scalar::ggx_distribution(f.alpha, h) * std::max(0.0f, dot(w, h)));
                    },
                    400, 400);
                EXPECT_NEAR(area, 1, 2e-3) << anisotropy;
                // What faces away is 1 + lambda less than what faces here (Heitz 2014).
                EXPECT_NEAR(seen, double(cosine * (1 + scalar::facets_lambda(f, w))), 3e-3)
                    << anisotropy << ' ' << azimuth << ' ' << cosine;
            }
}

TEST(Facets, are_drawn_as_often_as_they_are_seen) {
    const HemisphereCells cells{.fine = 64}; // narrow about the pole
    for (const float anisotropy : {0.5f, 0.9f})
        for (const float azimuth : {0.3f, 1.4f}) {
            const Facets f = scalar::make_facets(0.6f, anisotropy);
            const Vec3f wo = direction(0.4f, azimuth);
            Random random(6);
            const auto draw = [&] { return scalar::sample_ggx_normal(f.alpha, wo, random.next_pair()); };
            const auto get_density = [&](const Vec3f& h) {
                return scalar::ggx_distribution(f.alpha, h) * std::max(0.0f, dot(wo, h)) /
                       (wo.z * (1 + scalar::facets_lambda(f, wo)));
            };
            EXPECT_LT(measure_chi2(cells, draw, get_density), chi_square_limit(cells.count() - 1))
                << anisotropy << ' ' << azimuth;
        }
}

TEST(Facets, are_rougher_along_the_tangent) {
    const Facets f = scalar::make_facets(0.5f, 0.8f);
    const Vec3f along = normalize(Vec3f{0.3f, 0, 1}), across = normalize(Vec3f{0, 0.3f, 1});
    EXPECT_GT(scalar::ggx_distribution(f.alpha, along), 10 * scalar::ggx_distribution(f.alpha, across));
    EXPECT_GT(scalar::find_seen_roughness(0.5f, 0.8f, along),
              scalar::find_seen_roughness(0.5f, 0.8f, across));
    EXPECT_FLOAT_EQ(scalar::find_azimuth(along), 1);
    EXPECT_FLOAT_EQ(scalar::find_azimuth(across), 0);
    EXPECT_EQ(scalar::find_azimuth({0, 0, 1}), 0);
}

TEST(Basis, goes_along_a_tangent_as_far_as_the_normal_lets_it) {
    Random random(3);
    for (int k = 0; k < 1000; ++k) {
        const Vec3f n =
            normalize(Vec3f{random.next(), random.next(), random.next()} - Vec3f{0.5f, 0.5f, 0.5f});
        const Vec3f tangent = Vec3f{random.next(), random.next(), random.next()} * 3.0f;
        const scalar::Basis basis = scalar::make_basis_along(n, tangent);
        ASSERT_EQ(basis.n, n);
        ASSERT_NEAR(dot(basis.t, n), 0, 1e-4);
        ASSERT_NEAR(length(basis.t), 1, 1e-6);
        ASSERT_NEAR(dot(cross(basis.t, basis.b), n), 1, 1e-4);
        ASSERT_GE(dot(basis.t, tangent), 0);
        ASSERT_NEAR(dot(basis.b, tangent), 0, 1e-4);
    }
    const Vec3f n = normalize(Vec3f{1, 2, 3});
    for (const Vec3f& none : {n * 2.0f, Vec3f{}}) {
        const scalar::Basis basis = scalar::make_basis_along(n, none), any = scalar::make_basis(n);
        EXPECT_EQ(basis.t, any.t);
    }
}

} // namespace
} // namespace relief
