#include <limits>

#include <gtest/gtest.h>

#include "formulas/environment.h"
#include "formulas/light.h"
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
