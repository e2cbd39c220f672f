// One ray against boxes and triangles: boxes never miss what is inside, and shared edges never leak.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "formulas/object_ray.h"

namespace relief {

namespace {

constexpr float kNoEnd = std::numeric_limits<float>::infinity();

Vec3f draw(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return {normal(random), normal(random), normal(random)};
}

TEST(object_ray, meets_every_box_around_a_point_of_it) {
    std::mt19937 random(3);
    for (int k = 0; k < 20000; ++k) {
        const Vec3f origin = draw(random) * 3.0f;
        Vec3f direction = draw(random);
        if (k % 3 == 0) direction.x = 0;
        if (k % 4 == 0) direction.y = 0;
        const float t = std::fabs(draw(random).x) * 5;
        const Vec3f p = origin + direction * t;
        const Vec3f spread = draw(random) * (k % 2 ? 0.1f : 0.0f);
        // Rounding of p itself is not the box's fault.
        const auto widen = [&](float value, float sign) {
            return value + sign * (4e-7f * (std::fabs(value) + t * 4) + 1e-7f);
        };
        const Vec3f lower{widen(std::min(p.x, p.x + spread.x), -1), widen(std::min(p.y, p.y + spread.y), -1),
                          widen(std::min(p.z, p.z + spread.z), -1)};
        const Vec3f upper{widen(std::max(p.x, p.x + spread.x), 1), widen(std::max(p.y, p.y + spread.y), 1),
                          widen(std::max(p.z, p.z + spread.z), 1)};
        const scalar::ObjectRay ray = scalar::make_object_ray(origin, direction);
        const scalar::BoxInterval interval = scalar::cross_box(ray, lower, upper, 0, kNoEnd);
        ASSERT_TRUE(scalar::is_box_met(interval)) << k;
        EXPECT_LE(interval.entry, t * 1.00001f + 1e-5f);
    }
}

TEST(object_ray, touches_the_face_of_a_box_that_it_runs_along) {
    const scalar::ObjectRay ray = scalar::make_object_ray({1, 0.5f, -2}, {0, 0, 1});
    EXPECT_TRUE(scalar::is_box_met(scalar::cross_box(ray, {0, 0, 0}, {1, 1, 1}, 0, kNoEnd)));
    EXPECT_TRUE(scalar::is_box_met(scalar::cross_box(ray, {1, 0, 0}, {2, 1, 1}, 0, kNoEnd)));
    EXPECT_FALSE(scalar::is_box_met(scalar::cross_box(ray, {1.01f, 0, 0}, {2, 1, 1}, 0, kNoEnd)));
}

TEST(object_ray, finds_one_of_the_triangles_around_a_vertex_or_edge) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int k = 0; k < 20000; ++k) {
        // A closed fan of four triangles about the origin; rays at its middle, and at its inner edges.
        const Vec3f rim[4] = {{1, 0.1f, 0}, {0.05f, 1, 0.2f}, {-1, 0, -0.1f}, {0, -1, 0.1f}};
        const Vec3f target = k % 2 ? rim[k % 4] * (0.9f * uniform(random)) : Vec3f{};
        const Vec3f origin = Vec3f{uniform(random) - 0.5f, uniform(random) - 0.5f, 3};
        const scalar::ObjectRay ray = scalar::make_object_ray(origin, target - origin);
        int hits = 0;
        for (int side = 0; side < 4; ++side) {
            const scalar::TriangleHit hit = scalar::intersect_sheared(
                ray, scalar::shear_vertex(ray, {}), scalar::shear_vertex(ray, rim[side]),
                scalar::shear_vertex(ray, rim[(side + 1) % 4]), 0, kNoEnd);
            if (hit.t == kNoEnd) continue;
            ++hits;
            EXPECT_NEAR(hit.t, 1, 1e-4f);
        }
        ASSERT_GE(hits, 1) << k;
    }
}

TEST(object_ray, gives_the_weights_of_the_corners) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> uniform(0.05f, 0.45f);
    for (int k = 0; k < 5000; ++k) {
        const Vec3f a = draw(random), b = draw(random), c = draw(random);
        if (length(cross(b - a, c - a)) < 0.3f) continue;
        const float wb = uniform(random), wc = uniform(random);
        const Vec3f p = a * (1 - wb - wc) + b * wb + c * wc;
        const Vec3f origin = p + cross(b - a, c - a) * 2.0f + draw(random) * 0.2f;
        const scalar::ObjectRay ray = scalar::make_object_ray(origin, p - origin);
        const scalar::TriangleHit hit =
            scalar::intersect_sheared(ray, scalar::shear_vertex(ray, a), scalar::shear_vertex(ray, b),
                                      scalar::shear_vertex(ray, c), 0, kNoEnd);
        ASSERT_NEAR(hit.t, 1, 1e-4f) << k;
        EXPECT_NEAR(hit.weight_b, wb, 1e-3f);
        EXPECT_NEAR(hit.weight_c, wc, 1e-3f);
    }
}

} // namespace

} // namespace relief
