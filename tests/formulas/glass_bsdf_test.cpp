// Glass: Fresnel's equations, energy, reciprocity over the two media, densities over the whole sphere, and
// the choice between glass and what is mixed with it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "formulas/ggx_albedo.h"
#include "formulas/ggx_table.h"
#include "formulas/glass_bsdf.h"
#include "formulas/glass_vertex.h"
#include "formulas/sobol.h"
#include "hemisphere.h"
#include "statistics.h"
#include "support/net_points.h"

namespace relief {
namespace {

using scalar::GlassBsdf;
using scalar::GlassParameters;

GlassParameters make_glass(float ior, float kind = scalar::kSolidGlass, float anisotropy = 0) {
    return {.weight = 1,
            .ior = ior,
            .specular_color = {1, 1, 1},
            .tint = {1, 1, 1},
            .depth = {0, 0, 0},
            .anisotropy = anisotropy,
            .kind = kind};
}

/// What comes back per unit of radiance around, that of the inside being as large as it is in equilibrium:
/// outside times the square of the ior.
double estimate_albedo(const GlassBsdf& bsdf, float cosine) {
    const Vec3f wo = direction(cosine, 0.3f);
    const uint32_t n = 1u << 14;
    const bool is_wall = bsdf.glass.kind >= scalar::kRoughWall;
    double sum = 0;
    for (uint32_t k = 0; k < n; ++k) {
        const test::NetPoint u = test::find_net_point(k, n);
        const auto drawn = scalar::sample_glass_bsdf(bsdf, wo, u.x, u.yz);
        const float radiance = drawn.direction.z < 0 && !is_wall ? bsdf.ior * bsdf.ior : 1;
        sum += double(drawn.weight.x * radiance);
    }
    return sum / n;
}

TEST(Fresnel, is_that_of_normal_incidence_of_brewsters_angle_and_total_beyond_the_critical_one) {
    EXPECT_NEAR(scalar::refract_at(1, 1.5f).reflected, 0.04, 1e-6);
    EXPECT_NEAR(scalar::refract_at(1, 1 / 1.5f).reflected, 0.04, 1e-6);
    // Half of the light is not reflected at all there: r is the other half's ((n^2 - 1) / (n^2 + 1))^2.
    const float brewster = std::cos(std::atan(1.5f));
    EXPECT_NEAR(scalar::refract_at(brewster, 1.5f).reflected, 0.5 * std::pow(1.25 / 3.25, 2), 1e-6);
    const double critical = std::sqrt(1 - 1 / 2.25);
    EXPECT_EQ(scalar::refract_at(float(critical) - 1e-4f, 1 / 1.5f).reflected, 1);
    EXPECT_LT(scalar::refract_at(float(critical) + 1e-3f, 1 / 1.5f).reflected, 0.9f);
    EXPECT_EQ(scalar::refract_at(0, 1.5f).reflected, 1);
    EXPECT_EQ(scalar::refract_at(0, 1 / 1.5f).reflected, 1);
}

TEST(Fresnel, is_the_same_both_ways) {
    for (float cosine = 0.01f; cosine < 1; cosine += 0.05f) {
        const scalar::Refraction in = scalar::refract_at(cosine, 1.7f);
        const scalar::Refraction out = scalar::refract_at(in.cosine, 1 / 1.7f);
        EXPECT_NEAR(out.reflected, in.reflected, 2e-5) << cosine;
        EXPECT_NEAR(out.cosine, cosine, 1e-5);
    }
}

TEST(ThinWall, sums_up_the_reflections_between_its_faces) {
    const float f = scalar::refract_at(0.7f, 1.5f).reflected;
    const scalar::WallLight white = scalar::meet_wall(make_glass(1.5f, scalar::kRoughWall), 0.7f);
    EXPECT_NEAR(white.reflected.x, 2 * f / (1 + f), 1e-6);
    EXPECT_NEAR(white.reflected.x + white.passed.x, 1, 1e-6);
    GlassParameters tinted = make_glass(1.5f, scalar::kRoughWall);
    tinted.depth = {1, 0, 3}; // half, all, an eighth
    const scalar::WallLight straight = scalar::meet_wall(tinted, 1);
    EXPECT_NEAR(straight.passed.x, 0.96 * 0.96 * 0.5 / (1 - 0.04 * 0.04 * 0.25), 1e-6);
    EXPECT_NEAR(straight.reflected.x, 0.04 + 0.96 * 0.96 * 0.04 * 0.25 / (1 - 0.04 * 0.04 * 0.25), 1e-6);
    EXPECT_EQ(straight.passed.y, scalar::meet_wall(make_glass(1.5f, scalar::kRoughWall), 1).passed.y);
    // Slanted ways are longer.
    EXPECT_LT(scalar::meet_wall(tinted, 0.3f).passed.z / white.passed.z, 0.125f);
}

/// The same of solid glass in double precision, over all facet normals: what Fresnel reflects and refracts to
/// the side that it belongs to, less what other facets are in the way of.
double integrate_albedo(double ior, double roughness, double cosine) {
    const double alpha2 = std::pow(roughness, 4), pi = std::numbers::pi;
    const Vec3<double> wo{std::sqrt(1 - cosine * cosine), 0, cosine};
    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + alpha2 * (1 / (c * c) - 1)) - 1); };
    double sum = 0;
    constexpr int kRows = 4000, kColumns = 120;
    for (int i = 0; i < kRows; ++i) {
        // By the distribution of slopes: tan^2 = alpha^2 u / (1 - u).
        const double u = (i + 0.5) / kRows, tan2 = alpha2 * u / (1 - u), z = 1 / std::sqrt(1 + tan2);
        for (int j = 0; j < kColumns; ++j) {
            const double phi = 2 * pi * (j + 0.5) / kColumns, sine = std::sqrt(1 - z * z);
            const Vec3<double> h{sine * std::cos(phi), sine * std::sin(phi), z};
            const double c = dot(wo, h);
            if (c <= 0) continue;
            const double sine2 = (1 - c * c) / (ior * ior), t = std::sqrt(std::max(0.0, 1 - sine2));
            const double s = (c - ior * t) / (c + ior * t), p = (ior * c - t) / (ior * c + t);
            const double f = sine2 >= 1 ? 1 : 0.5 * (s * s + p * p);
            const double up = 2 * c * h.z - wo.z, down = (c / ior - t) * h.z - wo.z / ior;
            // Projected area of the facets, over that of the surface.
            const double seen = c / (z * cosine);
            if (up > 0) sum += f * seen / (1 + lambda(cosine) + lambda(up));
            if (down < 0) sum += (1 - f) * seen / (1 + lambda(cosine) + lambda(-down));
        }
    }
    return sum / (kRows * kColumns);
}

TEST(GlassBsdf, of_white_loses_what_facets_send_onto_each_other_and_nothing_else) {
    for (const bool is_inside : {false, true})
        for (const float roughness : {0.1f, 0.3f, 0.5f, 0.8f})
            for (const float cosine : {0.1f, 0.3f, 0.6f, 0.95f}) {
                const GlassBsdf bsdf = scalar::make_glass_bsdf(make_glass(1.5f), roughness, is_inside);
                const double expected =
                    integrate_albedo(is_inside ? 1 / 1.5 : 1.5, double(roughness), double(cosine));
                EXPECT_NEAR(estimate_albedo(bsdf, cosine), expected, 0.004)
                    << is_inside << ' ' << roughness << ' ' << cosine;
                EXPECT_LE(expected, 1 + 1e-4);
            }
}

TEST(GlassBsdf, of_white_and_smooth_or_a_thin_wall_keeps_nearly_all_light) {
    for (const float kind : {scalar::kSolidGlass, scalar::kRoughWall, scalar::kClearWall})
        for (const bool is_inside : {false, true})
            for (const float cosine : {0.1f, 0.3f, 0.6f, 0.95f}) {
                const double smooth =
                    estimate_albedo(scalar::make_glass_bsdf(make_glass(1.5f, kind), 0, is_inside), cosine);
                EXPECT_NEAR(smooth, 1, 2e-3) << kind << ' ' << is_inside << ' ' << cosine;
                if (kind == scalar::kSolidGlass) continue;
                // A wall sends all that facets reflect to one side or the other.
                const double rough =
                    estimate_albedo(scalar::make_glass_bsdf(make_glass(1.5f, kind), 0.5f, is_inside), cosine);
                const scalar::GgxAlbedo mirror = scalar::lookup_ggx_albedo(0.5f, cosine);
                EXPECT_NEAR(rough, double(mirror.scale + mirror.bias), 0.01) << kind << ' ' << cosine;
            }
}

TEST(GlassBsdf, is_reciprocal_with_the_squares_of_both_iors) {
    Random random(5);
    for (int k = 0; k < 2000; ++k) {
        const float ior = 1.05f + random.next();
        const float roughness = 0.1f + 0.9f * random.next();
        const GlassParameters glass = make_glass(ior, scalar::kSolidGlass, k % 2 == 0 ? 0 : random.next());
        const GlassBsdf outside = scalar::make_glass_bsdf(glass, roughness, false);
        const GlassBsdf inside = scalar::make_glass_bsdf(glass, roughness, true);
        const Vec3f a = direction(0.05f + 0.9f * random.next(), 6 * random.next());
        const Vec3f b = direction(0.05f + 0.9f * random.next(), 6 * random.next());
        for (const GlassBsdf& bsdf : {outside, inside}) {
            const float ab = scalar::evaluate_glass_bsdf(bsdf, a, b).value.x / b.z;
            const float ba = scalar::evaluate_glass_bsdf(bsdf, b, a).value.x / a.z;
            ASSERT_NEAR(ab, ba, 3e-4 * (double(ab) + 1e-3));
        }
        // From the side that it is seen from below is above.
        const float in = scalar::evaluate_glass_bsdf(outside, a, -b).value.x / b.z;
        const float out = scalar::evaluate_glass_bsdf(inside, b, -a).value.x / a.z;
        ASSERT_NEAR(in * ior * ior, out, 1e-2 * (double(out) + 1e-3)) << ior << ' ' << roughness;
    }
}

TEST(GlassBsdf, has_a_density_that_sums_up_to_the_directions_that_are_kept) {
    for (const float kind : {scalar::kSolidGlass, scalar::kRoughWall})
        for (const bool is_inside : {false, true})
            for (const float roughness : {0.4f, 0.7f}) {
                const GlassBsdf bsdf = scalar::make_glass_bsdf(make_glass(1.5f, kind), roughness, is_inside);
                const Vec3f wo = direction(0.7f, 1);
                double integral = 0;
                for (const float side : {1.0f, -1.0f})
                    integral += integrate_hemisphere(
                        [&](const Vec3f& wi) {
                            return scalar::evaluate_glass_bsdf(bsdf, wo, {wi.x, wi.y, side * wi.z}).pdf;
                        },
                        400, 400);
                int kept = 0;
                const uint32_t n = 1u << 14;
                for (uint32_t k = 0; k < n; ++k)
                    kept += scalar::sample_glass_bsdf(bsdf, wo, scalar::sobol_pair(3, k, 0).x,
                                                      scalar::sobol_pair(3, k, 1))
                                .pdf > 0;
                EXPECT_NEAR(integral, double(kept) / n, 6e-3) << kind << ' ' << is_inside << ' ' << roughness;
            }
}

TEST(GlassBsdf, draws_directions_as_its_density_says) {
    const HemisphereCells cells{.fine = 16};
    for (const float kind : {scalar::kSolidGlass, scalar::kRoughWall})
        for (const bool is_inside : {false, true})
            for (const float side : {1.0f, -1.0f}) {
                const GlassBsdf bsdf =
                    scalar::make_glass_bsdf(make_glass(1.6f, kind, is_inside ? 0.5f : 0.0f), 0.6f, is_inside);
                const Vec3f wo = direction(0.6f, 0.7f);
                Random random(6);
                const auto turn = [&](const Vec3f& d) { return Vec3f{d.x, d.y, side * d.z}; };
                const auto draw = [&] {
                    const float lobe = random.next();
                    const auto drawn = scalar::sample_glass_bsdf(bsdf, wo, lobe, random.next_pair());
                    return drawn.pdf > 0 ? turn(drawn.direction) : Vec3f{0, 0, -1};
                };
                const auto get_density = [&](const Vec3f& wi) {
                    return scalar::evaluate_glass_bsdf(bsdf, wo, turn(wi)).pdf;
                };
                EXPECT_LT(measure_chi2(cells, draw, get_density), chi_square_limit(cells.count() - 1))
                    << kind << ' ' << is_inside << ' ' << side;
            }
}

TEST(GlassBsdf, gives_weights_that_are_value_over_density_and_no_larger_than_radiance_changes) {
    Random random(7);
    for (int k = 0; k < 20000; ++k) {
        const float ior = 1.01f + 2 * random.next();
        const float kind = std::floor(3 * random.next());
        const GlassBsdf bsdf = scalar::make_glass_bsdf(make_glass(ior, kind, k % 2 == 0 ? 0 : random.next()),
                                                       random.next(), random.next() < 0.5f);
        const Vec3f wo = normalize(direction(1e-4f + 0.9998f * random.next(), 2));
        const float lobe = random.next();
        const auto drawn = scalar::sample_glass_bsdf(bsdf, wo, lobe, random.next_pair());
        ASSERT_TRUE(is_finite(drawn.weight) && std::isfinite(drawn.pdf));
        if (!(drawn.pdf > 0)) {
            ASSERT_EQ(drawn.weight, (Vec3f{0, 0, 0}));
            continue;
        }
        const auto value = scalar::evaluate_glass_bsdf(bsdf, wo, drawn.direction);
        ASSERT_FLOAT_EQ(drawn.pdf, value.pdf);
        ASSERT_NEAR(drawn.weight.x * drawn.pdf, value.value.x, 1e-4f * (value.value.x + 1e-6f));
        const bool is_refracted = drawn.direction.z < 0 && kind < scalar::kRoughWall;
        ASSERT_LE(drawn.weight.x, (is_refracted ? 1 / (bsdf.ior * bsdf.ior) : 1) * 1.0001f);
    }
}

TEST(GlassBsdf, of_smooth_glass_bends_light_by_the_law_of_snell) {
    for (const bool is_inside : {false, true}) {
        const GlassBsdf bsdf = scalar::make_glass_bsdf(make_glass(1.5f), 0, is_inside);
        const Vec3f wo = direction(0.9f, 0);
        Random random(8);
        for (int k = 0; k < 100; ++k) {
            const Vec2f u{random.next(), 0.01f + 0.98f * random.next()};
            const auto drawn = scalar::sample_glass_bsdf(bsdf, wo, 0.9f, u);
            ASSERT_LT(drawn.direction.z, 0);
            ASSERT_NEAR(drawn.direction.x, -wo.x / bsdf.ior, 0.02);
        }
    }
}

TEST(GlassVertex, is_glass_as_often_as_its_weight_says) {
    GlassParameters g = make_glass(1.5f);
    g.weight = 0.6f;
    int count = 0;
    double sum = 0;
    for (int k = 0; k < 1000; ++k) {
        const scalar::GlassDraw drawn = scalar::draw_glass(g, 0.5f, 0.8f, (float(k) + 0.5f) / 1000);
        count += drawn.is_glass;
        sum += double(drawn.u);
        ASSERT_TRUE(drawn.u >= 0 && drawn.u < 1);
        ASSERT_EQ(drawn.weight, (Vec3f{1, 1, 1}));
        if (!drawn.is_glass) ASSERT_NEAR(drawn.metallic, 0.5 / 0.7, 1e-6);
    }
    EXPECT_EQ(count, 300);
    EXPECT_NEAR(sum / 1000, 0.5, 1e-3);
}

/// What a clear wall and what it is mixed with give together, all of it white: nothing is lost or gained.
TEST(GlassVertex, of_clear_walls_is_passed_or_met_as_the_sum_of_both_says) {
    for (const float weight : {0.3f, 1.0f})
        for (const float metallic : {0.0f, 0.4f, 1.0f})
            for (const float opacity : {0.2f, 1.0f})
                for (const float cosine : {0.03f, 0.5f, 1.0f}) {
                    GlassParameters g = make_glass(1.5f, scalar::kClearWall);
                    g.weight = weight;
                    const float passed = scalar::pass_clear_wall(g, metallic, opacity, cosine).x;
                    double met = 0;
                    for (int k = 0; k < 4096; ++k) {
                        const float weight_met =
                            scalar::draw_glass(g, metallic, cosine, (float(k) + 0.5f) / 4096).weight.x;
                        ASSERT_LE(weight_met, 1.0001f);
                        met += double(weight_met) / 4096;
                    }
                    EXPECT_NEAR(double(passed) + (1 - double(passed)) * met, 1, 1e-3)
                        << weight << ' ' << metallic << ' ' << opacity << ' ' << cosine;
                }
}

TEST(GlassVertex, of_tinted_walls_reflects_what_the_wall_does_not_let_pass_or_keep) {
    GlassParameters g = make_glass(1.5f, scalar::kClearWall);
    g.depth = {0.2f, 1, 4};
    const float cosine = 0.4f;
    const scalar::WallLight wall = scalar::meet_wall(g, cosine);
    const Vec3f left = scalar::pass_clear_wall(g, 0, 1, cosine);
    EXPECT_EQ(left, wall.passed);
    const Vec3f met = scalar::draw_glass(g, 0, cosine, 0.5f).weight * (1 - scalar::largest_component(left));
    EXPECT_NEAR(met.x, wall.reflected.x, 1e-5);
    EXPECT_NEAR(met.y, wall.reflected.y, 1e-5);
    EXPECT_NEAR(met.z, wall.reflected.z, 1e-5);
}

} // namespace
} // namespace relief
