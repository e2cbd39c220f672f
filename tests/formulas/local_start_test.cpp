// Where rays begin for objects that are far away from them.
#include "formulas/local_start.h"

#include <random>

#include <gtest/gtest.h>

namespace relief {
namespace {

struct FarRay {
    Vec3f origin, direction, center;
};

/// Past an object of size 1, at most 10^6 away.
FarRay draw_ray(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3f{normal(random), normal(random), normal(random)}; };
    FarRay ray;
    ray.origin = draw() * 1e5f, ray.center = draw() * 3e5f;
    ray.direction = ((ray.center + draw()) - ray.origin) * std::exp2(normal(random) * 10);
    return ray;
}

TEST(LocalStart, is_a_point_of_the_ray_before_the_object_and_rounded_once) {
    std::mt19937 random(5);
    for (int k = 0; k < 20000; ++k) {
        const auto [o, d, center] = draw_ray(random);
        if (!scalar::is_far_away(o, center, 1)) continue;
        const scalar::LocalStart start = scalar::find_local_start(o, d, k % 2 ? center : Vec3f{}, center, 1);
        ASSERT_GT(start.shift, 0) << k;
        double squared = 0, along = 0;
        for (int c = 0; c < 3; ++c) {
            const double from = k % 2 ? double(get_component(center, c)) : 0.0;
            const double place =
                double(get_component(o, c)) + double(start.shift) * double(get_component(d, c));
            const double found = double(get_component(start.origin, c));
            ASSERT_NEAR(found, place - from, 3e-7 * std::fabs(place - from) + 1e-6) << k << " " << c;
            const double back = double(get_component(center, c)) - place;
            squared += back * back, along += back * double(get_component(d, c));
        }
        // Outside of the sphere, the middle in front, and not far before it.
        ASSERT_GT(along, 0) << k;
        ASSERT_GT(squared, 1) << k;
        ASSERT_LT(std::sqrt(squared), 16) << k;
    }
}

TEST(LocalStart, is_the_origin_of_rays_that_begin_near_or_go_away) {
    const Vec3f center{3e5f, 0, 0}, near{3e5f + 20, 5, 0};
    const scalar::LocalStart own = scalar::find_local_start(near, {-1, 0, 0}, center, center, 1);
    EXPECT_EQ(own.origin, (Vec3f{20, 5, 0}));
    EXPECT_EQ(own.shift, 0);
    EXPECT_EQ(scalar::find_local_start({}, {-1, 0, 0}, center, center, 1).shift, 0);
    EXPECT_EQ(scalar::find_local_start({}, {0, 0, 0}, center, center, 1).shift, 0);
    EXPECT_GT(scalar::find_local_start({}, {1, 0, 0}, center, center, 1).shift, 2.9e5f);
}

} // namespace
} // namespace relief
