#include <random>

#include <gtest/gtest.h>

#include "formulas/normal_map.h"

namespace relief {
namespace {

Vec3f draw_unit(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return normalize(Vec3f{x, y, z});
}

TEST(NormalMap, decodes_directions_with_a_scale_and_never_below_the_surface) {
    EXPECT_EQ(scalar::decode_normal({0.5f, 0.5f, 1}, {1, 1}), (Vec3f{0, 0, 1}));
    EXPECT_EQ(scalar::decode_normal({1, 0, 0.75f}, {0.5f, 2}), (Vec3f{0.5f, -2, 0.5f}));
    EXPECT_EQ(scalar::decode_normal({1, 0.25f, 0}, {1, -1}), (Vec3f{1, 0.5f, 0}));
}

TEST(NormalMap, turns_tangents_by_the_shortest_rotation) {
    std::mt19937 random(4);
    for (int k = 0; k < 10000; ++k) {
        const Vec3f base = draw_unit(random), normal = draw_unit(random);
        const Vec3f any = draw_unit(random), tangent = normalize(any - base * dot(base, any));
        const Vec3f turned = scalar::turn_tangent(tangent, base, normal);
        ASSERT_NEAR(length(turned), 1, 1e-5f);
        ASSERT_NEAR(dot(turned, normal), 0, 1e-5f);
        if (dot(base, normal) < -0.99f) continue; // nearly any rotation is the shortest
        // The axis of the rotation stays, and so does the angle to it.
        const Vec3f axis = normalize(cross(base, normal));
        ASSERT_NEAR(dot(turned, axis), dot(tangent, axis), 1e-3f) << k;
        ASSERT_NEAR(dot(cross(normal, turned), axis), dot(cross(base, tangent), axis), 1e-3f) << k;
        ASSERT_LT(length(scalar::turn_tangent(tangent, base, base) - tangent), 1e-5f);
    }
}

TEST(NormalMap, has_a_frame_where_nothing_tells_one) {
    const Vec3f up{0, 0, 1};
    for (const Vec3f& tangent : {Vec3f{}, up, -up})
        for (const Vec3f& normal : {up, -up}) {
            const Vec3f turned = scalar::turn_tangent(tangent, up, normal);
            EXPECT_NEAR(length(turned), 1, 1e-6f);
            EXPECT_NEAR(dot(turned, normal), 0, 1e-6f);
        }
}

TEST(NormalMap, maps_a_direction_through_the_frame) {
    const Vec3f n{0, 1, 0}, t{1, 0, 0};
    EXPECT_EQ(scalar::map_normal(n, t, 1, {0, 0, 2}), n);
    EXPECT_EQ(scalar::map_normal(n, t, 1, {0, 0, 0}), n);
    EXPECT_EQ(scalar::map_normal(n, t, 1, {3, 0, 0}), t);
    EXPECT_EQ(scalar::map_normal(n, t, 1, {0, 1, 0}), (Vec3f{0, 0, -1}));
    EXPECT_EQ(scalar::map_normal(n, t, -1, {0, 1, 0}), (Vec3f{0, 0, 1}));
}

} // namespace
} // namespace relief
