#include <limits>

#include <gtest/gtest.h>

#include "formulas/environment.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "formulas/shading_normal.h"
#include "formulas/warp.h"
#include "statistics.h"

namespace relief {
namespace {

TEST(Latlong, looks_along_minus_z_in_the_middle_and_right_is_x) {
    const Vec3f middle = scalar::latlong_to_direction({0.5f, 0.5f});
    EXPECT_NEAR(middle.z, -1, 1e-6);
    EXPECT_NEAR(scalar::latlong_to_direction({0.75f, 0.5f}).x, 1, 1e-6);
    EXPECT_NEAR(scalar::latlong_to_direction({0.3f, 0.0f}).y, 1, 1e-6);
}

TEST(Latlong, maps_directions_there_and_back) {
    Random random(1);
    for (int k = 0; k < 2000; ++k) {
        const Vec3f d = normalize(scalar::square_to_sphere(random.next_pair()));
        const Vec2f p = scalar::direction_to_latlong(d);
        ASSERT_GE(p.x, 0);
        ASSERT_LE(p.x, 1);
        ASSERT_LT(length(scalar::latlong_to_direction(p) - d), 2e-3f * std::fabs(d.y) + 1e-5f);
    }
}

TEST(PowerHeuristic, sums_up_to_one_and_knows_delta_lights) {
    EXPECT_FLOAT_EQ(scalar::power_heuristic(2, 3) + scalar::power_heuristic(3, 2), 1);
    EXPECT_EQ(scalar::power_heuristic(std::numeric_limits<float>::infinity(), 3), 1);
    EXPECT_EQ(scalar::power_heuristic(3, 0), 1);
    EXPECT_EQ(scalar::power_heuristic(0, 3), 0);
}

TEST(SphereLight, is_hit_by_every_direction_of_its_cone_and_no_other) {
    const Vec3f center{0, 0, 5};
    const float height = scalar::sphere_cone_height(2, 5);
    EXPECT_NEAR(height, 1 - std::sqrt(1 - 0.16), 1e-6);
    for (float u : {0.0f, 0.5f, 0.99f})
        EXPECT_GT(scalar::sphere_distance(center, 2, scalar::square_to_cone({u, 0.3f}, height)), 0);
    EXPECT_LT(scalar::sphere_distance(center, 2, scalar::square_to_cone({1, 0.3f}, height * 1.01f)), 0);
    EXPECT_FLOAT_EQ(scalar::sphere_distance(center, 2, {0, 0, 1}), 3);
    EXPECT_FLOAT_EQ(scalar::sphere_distance({0, 0, 1}, 2, {0, 0, 1}), 3);
    EXPECT_EQ(scalar::sphere_cone_height(2, 1), 2);
    EXPECT_NEAR(scalar::sphere_cone_height(1, 1e6f), 5e-13, 1e-15);
}

scalar::LightSourceData make_flat(uint32_t kind) {
    scalar::LightSourceData source{};
    source.kind = kind;
    source.power = source.strength = 2;
    source.color = {1, 1, 1};
    source.center = {0.3f, -0.2f, 1.2f};
    source.basis = scalar::make_basis(normalize(Vec3f{0.2f, 0.3f, -1}));
    source.radius = 0.8f, source.half_width = 0.9f, source.half_height = 0.4f;
    source.radius2 = scalar::shape_area(source) / (2 * std::numbers::pi_v<float>);
    return source;
}

TEST(FlatLight, has_a_density_whose_integral_is_one) {
    for (uint32_t kind : {scalar::kSourceRectangle, scalar::kSourceDisk}) {
        const scalar::LightSourceData source = make_flat(kind);
        const auto density = [&](const Vec3f& d) {
            return scalar::meet_light(source, {}, d, scalar::make_infinity()).pdf;
        };
        EXPECT_NEAR(integrate_hemisphere(density, 1500, 1500), 1, 2e-3) << kind;
    }
}

TEST(FlatLight, is_drawn_with_the_density_that_it_is_met_with) {
    Random random(3);
    for (uint32_t kind : {scalar::kSourceRectangle, scalar::kSourceDisk}) {
        const scalar::LightSourceData source = make_flat(kind);
        int missed = 0;
        Vec3f sum{};
        for (int k = 0; k < 20000; ++k) {
            const scalar::LightDraw drawn = scalar::draw_listed_light(source, {}, random.next_pair());
            ASSERT_NEAR(length(drawn.direction), 1, 1e-5);
            const scalar::LightSeen seen =
                scalar::meet_light(source, {}, drawn.direction, drawn.distance * 1.001f);
            missed += seen.pdf == 0; // by rounding, at the rim
            if (seen.pdf == 0) continue;
            ASSERT_NEAR(seen.pdf, drawn.pdf, 1e-4f * drawn.pdf);
            ASSERT_NEAR(seen.radiance.x, drawn.weight.x * drawn.pdf, 1e-4f * seen.radiance.x);
            EXPECT_EQ(scalar::meet_light(source, {}, drawn.direction, drawn.distance * 0.99f).pdf, 0);
            sum += drawn.direction * drawn.distance;
        }
        EXPECT_LT(missed, 5);
        EXPECT_LT(length(sum * (1 / 20000.0f) - source.center), 0.02f) << "all over the light";
    }
}

TEST(FlatLight, keeps_its_brightness_as_far_away_as_places_go) {
    for (uint32_t kind : {scalar::kSourceRectangle, scalar::kSourceDisk, scalar::kSourcePoint})
        for (const float distance : {1e3f, 5e12f, 1e13f, 1e15f, 1e17f}) {
            scalar::LightSourceData source = make_flat(kind);
            source.basis.n = {0, 0, -1};
            source.center = {0, 0, distance};
            source.strength = distance;
            const scalar::LightDraw drawn = scalar::draw_listed_light(source, {}, {0.4f, 0.6f});
            EXPECT_GT(drawn.pdf, 0) << kind << ' ' << distance;
            EXPECT_NEAR(drawn.weight.x * distance, 1, 1e-3f) << kind << ' ' << distance;
        }
}

TEST(FlatLight, has_the_density_of_its_plain_form_where_that_is_finite) {
    Random random(7);
    for (int k = 0; k < 20000; ++k) {
        const float distance = std::exp2(80 * random.next() - 40), area = std::exp2(40 * random.next() - 20);
        const float facing = distance * (0.01f + 0.99f * random.next());
        const float plain = distance * distance * distance / (facing * area);
        const float found = scalar::flat_density(distance, facing, area);
        if (distance < 1e12f) {
            ASSERT_EQ(found, plain);
        } else {
            ASSERT_NEAR(found / (distance / facing * distance / area * distance), 1, 1e-5f);
        }
    }
    EXPECT_GT(scalar::flat_density(1e17f, 1e17f, 1e-2f), 9e35f);
    EXPECT_LT(scalar::flat_density(1e17f, 1e17f, 1e-2f), 1.1e36f);
}

TEST(FlatLight, shines_to_one_side) {
    for (uint32_t kind : {scalar::kSourceRectangle, scalar::kSourceDisk}) {
        scalar::LightSourceData source = make_flat(kind);
        EXPECT_GT(scalar::estimate_irradiance(source, {}), 0);
        source.basis.n = -source.basis.n;
        EXPECT_EQ(scalar::draw_listed_light(source, {}, {0.4f, 0.6f}).pdf, 0);
        EXPECT_EQ(scalar::meet_light(source, {}, normalize(source.center), scalar::make_infinity()).pdf, 0);
        EXPECT_EQ(scalar::estimate_irradiance(source, {}), 0);
    }
}

TEST(FlatLight, is_estimated_by_about_its_solid_angle) {
    Random random(4);
    for (uint32_t kind : {scalar::kSourceRectangle, scalar::kSourceDisk}) {
        const scalar::LightSourceData source = make_flat(kind);
        for (int k = 0; k < 300; ++k) {
            const Vec3f away{4 * random.next() - 2, 4 * random.next() - 2, 0.02f + 2 * random.next()};
            const Vec3f at = source.center + scalar::from_local(source.basis, away);
            double light = 0;
            for (int n = 0; n < 4000; ++n) {
                const scalar::LightDraw drawn = scalar::draw_listed_light(source, at, random.next_pair());
                light += drawn.weight.x / 4000;
            }
            const float estimate = scalar::estimate_irradiance(source, at);
            ASSERT_GT(estimate, 0.4 * light) << away.x << ' ' << away.y << ' ' << away.z;
            // Far too little would be noise, too much costs samples only.
            ASSERT_LT(estimate, 10 * light) << away.x << ' ' << away.y << ' ' << away.z;
        }
    }
}

TEST(SpotLight, is_estimated_as_dark_only_where_it_is) {
    Random random(5);
    scalar::LightSourceData source = make_flat(scalar::kSourceSpot);
    source.cone = 0.2f, source.edge = 0.05f, source.radius = 0.5f, source.radius2 = 0.25f;
    int dark = 0;
    for (int k = 0; k < 20000; ++k) {
        const Vec3f at = source.center + scalar::square_to_sphere(random.next_pair()) * (3 * random.next());
        const scalar::LightDraw drawn = scalar::draw_listed_light(source, at, random.next_pair());
        const float estimate = scalar::estimate_irradiance(source, at);
        dark += estimate == 0;
        if (drawn.weight.x > 1e-5f) ASSERT_GT(estimate, 0) << k;
    }
    EXPECT_GT(dark, 10000);
    source.radius = source.radius2 = 0;
    for (int k = 0; k < 2000; ++k) {
        const Vec3f at = source.center + scalar::square_to_sphere(random.next_pair());
        const scalar::LightDraw drawn = scalar::draw_listed_light(source, at, random.next_pair());
        ASSERT_NEAR(drawn.weight.x, scalar::estimate_irradiance(source, at), 1e-4f);
    }
}

TEST(BendNormal, keeps_the_mirror_image_above_the_surface) {
    Random random(2);
    const Vec3f geometric{0, 0, 1};
    for (int k = 0; k < 20000; ++k) {
        const Vec3f wo = normalize(scalar::square_to_cone(random.next_pair(), 1.0f));
        const Vec3f shading = normalize(scalar::square_to_cone(random.next_pair(), 1.0f));
        if (wo.z < 1e-4f) continue;
        const Vec3f bent = scalar::bend_normal(shading, geometric, wo);
        const Vec3f mirrored = bent * (2 * dot(wo, bent)) - wo;
        ASSERT_NEAR(length(bent), 1, 1e-5);
        ASSERT_GT(dot(bent, wo), 0);
        ASSERT_GT(mirrored.z, 0);
    }
    const Vec3f upright{0, 0.1f, 1};
    const Vec3f kept = scalar::bend_normal(normalize(upright), geometric, {0, 0, 1});
    EXPECT_EQ(kept, normalize(upright));
}

} // namespace
} // namespace relief
