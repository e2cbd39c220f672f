#include "support/slab_ray.h"

#include <gtest/gtest.h>

#include "support/box_sets.h"

namespace relief {
namespace {

constexpr float kMiss = std::numeric_limits<float>::infinity();

float enter(const Box& box, const BoxRay& ray) {
    return SlabRay(ray).compute_entry(box, ray.t_min, ray.t_max);
}

/// Small integers: sums and differences of them are exact, so that the target is exactly at t = 1.
Vec3f make_grid_point(std::mt19937& random, int size) {
    std::uniform_int_distribution<int> number(-size, size);
    const int x = number(random), y = number(random), z = number(random);
    return {float(x), float(y), float(z)};
}

TEST(SlabRay, never_misses_a_box_around_a_point_that_the_ray_reaches) {
    std::mt19937 random(1);
    for (int k = 0; k < 300000; ++k) {
        // The target is inside, on a face, an edge or a corner of a box that may be flat; coordinates often
        // coincide.
        const int size = k % 2 == 0 ? 2 : 5000;
        const Vec3f target = make_grid_point(random, size), origin = make_grid_point(random, size);
        if (origin == target) continue;
        Box box;
        box.extend(target);
        const Vec3f other = make_grid_point(random, size);
        for (int axis = 0; axis < 3; ++axis)
            if (random() % 3 != 0) {
                Vec3f corner = target;
                set_component(corner, axis, get_component(other, axis));
                box.extend(corner);
            }
        BoxRay ray{origin, target - origin, 0, 1};
        ASSERT_NE(enter(box, ray), kMiss);
        ray.t_min = 1;
        ASSERT_NE(enter(box, ray), kMiss);
        ray.direction = ray.direction * 0x1p-80f;
        ray.t_min = 0, ray.t_max = 0x1p80f;
        ASSERT_NE(enter(box, ray), kMiss);
    }
}

TEST(SlabRay, misses_boxes_beside_behind_and_beyond) {
    const Box box{{1, 1, 1}, {2, 2, 2}};
    EXPECT_EQ(enter(box, {{0, 0, 0}, {1, 0, 0}}), kMiss);
    EXPECT_EQ(enter(box, {{0, 1.5f, 1.5f}, {-1, 0, 0}}), kMiss);
    EXPECT_EQ(enter(box, {{0, 1.5f, 1.5f}, {1, 0, 0}, 0, 0.9f}), kMiss);
    EXPECT_EQ(enter(box, {{0, 1.5f, 1.5f}, {1, 0, 0}, 2.1f, 10}), kMiss);
    EXPECT_EQ(enter(box, {{0, 1.5f, 2.001f}, {1, 0, -0.0f}}), kMiss);
    EXPECT_EQ(enter(box, {{0, 0, 0}, {1, 1, 3}}), kMiss);
}

TEST(SlabRay, enters_at_the_face_or_at_t_min) {
    const Box box{{1, 1, 1}, {2, 2, 2}};
    EXPECT_EQ(enter(box, {{0, 1.5f, 1.5f}, {0.5f, 0, 0}}), 2);
    EXPECT_EQ(enter(box, {{3, 1.5f, 1.5f}, {-1, 0, 0}}), 1);
    EXPECT_EQ(enter(box, {{1.5f, 1.5f, 1.5f}, {1, 0, 0}}), 0);
    EXPECT_EQ(enter(box, {{0, 1.5f, 1.5f}, {1, 0, 0}, 1.25f, 10}), 1.25f);
}

TEST(SlabRay, counts_faces_along_parallel_rays_as_inside) {
    const Box box{{1, 1, 1}, {2, 2, 2}};
    for (const float y : {1.0f, 2.0f})
        for (const float zero : {0.0f, -0.0f, 1e-45f, -1e-45f})
            EXPECT_EQ(enter(box, {{0, y, 1.5f}, {1, zero, zero}}), 1) << y << " " << zero;
}

TEST(SlabRay, works_at_huge_and_tiny_scale) {
    for (const float scale : {1e-30f, 1e30f}) {
        const Box box{Vec3f{1, 1, 1} * scale, Vec3f{2, 2, 2} * scale};
        EXPECT_NE(enter(box, {{0, 0, 0}, {1, 1, 1}}), kMiss);
        EXPECT_EQ(enter(box, {{0, 0, 0}, {1, 1, 3}}), kMiss);
    }
}

} // namespace
} // namespace relief
