// Footprints of rays: no place that a ray passes may be left out, whatever rounding does.
#include "cpu/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "cpu/picture_footprints.h"
#include "engine/picture_windows.h"
#include "support/box_sets.h"

namespace relief::cpu {

namespace {

const Box kBounds{{-1, -2, 3}, {2, 4, 4}};

bool meet(const Footprint& a, const Footprint& b) { return a.meets(b, b.find_used_words()); }

Footprint trace(const VoxelGrid& grid, const Vec3f& origin, const Vec3f& direction, float t_end) {
    Footprint footprint(grid);
    footprint.add_ray(origin, direction, t_end);
    return footprint;
}

Footprint cover(const VoxelGrid& grid, const Box& box) {
    Footprint footprint(grid);
    EXPECT_TRUE(footprint.add_box(box));
    return footprint;
}

Box make_box(const Vec3f& center, float half) {
    const Vec3f margin{half, half, half};
    return {max(center - margin, kBounds.lower), min(center + margin, kBounds.upper)};
}

Vec3f make_inside_point(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    const Vec3f extent = kBounds.extent();
    return kBounds.lower + Vec3f{extent.x * unit(random), extent.y * unit(random), extent.z * unit(random)};
}

} // namespace

TEST(Footprint, holds_every_place_that_a_ray_passes) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const size_t voxels : {1u, 100u, 5000u, 40000u}) {
        const VoxelGrid grid(kBounds, voxels);
        for (int k = 0; k < 2000; ++k) {
            const Vec3f through = make_inside_point(random);
            Vec3f direction = test::make_point(random, 1);
            // Rays along axes and planes are the ones that go wrong.
            if (k % 5 == 1) direction.x = 0;
            if (k % 5 == 2) direction.x = direction.z = 0;
            if (length(direction) == 0) continue;
            const float distance = std::pow(10.0f, 4 * unit(random) - 2);
            const Vec3f origin = through - direction * distance;
            const Footprint rays = trace(grid, origin, direction, distance * 1.001f);
            // `through` itself is off the ray by what rounding did to the origin.
            const float off = 1e-6f * (length(origin) + length(through));
            EXPECT_TRUE(meet(rays, cover(grid, make_box(through, off)))) << voxels << " voxels, ray " << k;
        }
    }
}

/// The box of floats around a place.
Box make_box_around(const std::array<double, 3>& p) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const float nearest = float(p[size_t(axis)]);
        set_component(box.lower, axis, nearest > p[size_t(axis)] ? std::nextafter(nearest, -2.0f) : nearest);
        set_component(box.upper, axis, nearest < p[size_t(axis)] ? std::nextafter(nearest, 2.0f) : nearest);
    }
    return box;
}

/// Ten voxels along each axis, and faces at 0, beside which floats are closest.
VoxelGrid make_even_grid() {
    VoxelGrid grid({{-1, -1, -1}, {1, 1, 1}}, 12 * 12 * 12);
    EXPECT_EQ(grid.voxel_count(), 12u * 12 * 12);
    return grid;
}

TEST(Footprint, holds_rays_that_go_along_a_face_closer_than_rounding) {
    const VoxelGrid grid = make_even_grid();
    for (const float aside : {1e-9f, -1e-9f})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f origin{0.3f, 0.3f, 0.3f}, direction{0, 0, 0};
            set_component(origin, axis, -3), set_component(origin, (axis + 1) % 3, aside);
            set_component(direction, axis, 1);
            const Vec3f place = origin + direction * 2.5f;
            EXPECT_TRUE(meet(trace(grid, origin, direction, 4), cover(grid, {place, place})))
                << aside << " beside axis " << axis;
        }
}

TEST(Footprint, holds_the_ends_of_rays_that_reach_just_through_a_face) {
    const VoxelGrid grid = make_even_grid();
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-0.9f, 0.9f);
    for (int k = 0; k < 3000; ++k) {
        const int axis = k % 3;
        const Vec3f origin{3 * unit(random), 3 * unit(random), 3 * unit(random)};
        Vec3f end{unit(random), unit(random), unit(random)};
        set_component(end, axis, 0);
        const Vec3f direction = end - origin;
        const auto find_place = [&](float t, int c) {
            return double(get_component(origin, c)) + double(t) * double(get_component(direction, c));
        };
        float t = 1;
        const bool is_falling = get_component(direction, axis) < 0;
        while (is_falling ? find_place(t, axis) >= 0 : find_place(t, axis) <= 0) t = std::nextafter(t, 2.0f);
        const Box box = make_box_around({find_place(t, 0), find_place(t, 1), find_place(t, 2)});
        EXPECT_TRUE(meet(trace(grid, origin, direction, t), cover(grid, box))) << "ray " << k;
    }
}

TEST(Footprint, leaves_out_what_is_behind_the_ends_and_aside) {
    const VoxelGrid grid(kBounds, 20000);
    const Footprint ray = trace(grid, {-3, 1, 3.5f}, {1, 0, 0}, 3.5f); // ends at x = 0.5
    EXPECT_TRUE(meet(ray, cover(grid, make_box({-0.9f, 1, 3.5f}, 0.01f))));
    EXPECT_TRUE(meet(ray, cover(grid, make_box({0.45f, 1, 3.5f}, 0.01f))));
    EXPECT_FALSE(meet(ray, cover(grid, make_box({0.8f, 1, 3.5f}, 0.01f))));
    EXPECT_FALSE(meet(ray, cover(grid, make_box({0, 1.4f, 3.5f}, 0.01f))));
    EXPECT_FALSE(meet(ray, cover(grid, make_box({0, 1, 3.1f}, 0.01f))));
    for (const Vec3f& direction : {Vec3f{-1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 0}})
        EXPECT_TRUE(trace(grid, {-3, 1, 3.5f}, direction, 100).find_used_words().empty());
}

TEST(Footprint, forgets_and_refuses_what_leaves_the_grid) {
    const VoxelGrid grid(kBounds, 1000);
    EXPECT_GE(grid.voxel_count(), 500u);
    Footprint footprint(grid);
    EXPECT_FALSE(footprint.add_box({{0, 0, 3.5f}, {2.1f, 1, 3.6f}}));
    EXPECT_TRUE(footprint.find_used_words().empty());
    EXPECT_TRUE(footprint.add_box(kBounds));
    EXPECT_FALSE(footprint.find_used_words().empty());
    footprint.clear();
    EXPECT_TRUE(footprint.find_used_words().empty());
    EXPECT_TRUE(footprint.add_box(Box{}));
}

TEST(Footprint, serves_flat_bounds_and_points) {
    for (const Box& bounds : {Box{{0, 0, 0}, {4, 3, 0}}, Box{{1, 1, 1}, {1, 1, 1}}}) {
        const VoxelGrid grid(bounds, 1000);
        Footprint ray(grid), box(grid);
        const Vec3f middle = bounds.center();
        ray.add_ray(middle - Vec3f{1, 2, 3}, {1, 2, 3}, 2);
        EXPECT_TRUE(box.add_box({middle, middle}));
        EXPECT_TRUE(meet(ray, box));
    }
}

TEST(PictureFootprints, names_the_stale_pixels_once) {
    const Window window{5, 3, 70, 41};
    PictureFootprints picture(window, kBounds);
    EXPECT_EQ(picture.start_stale_windows().size(), cut_into_windows(window, 8).size());
    picture.at(20, 30).add_ray({0, 0, 0}, {0, 0, 1}, 10);
    picture.at(69, 40).add_ray({0, 0, 0}, {0, 0, 1}, 10);
    picture.at(50, 10).add_ray({1, 1, 0}, {0, 0, 1}, 10);
    picture.finish();
    EXPECT_TRUE(picture.start_stale_windows().empty());
    const Box place[] = {{{-0.01f, -0.01f, 3.4f}, {0.01f, 0.01f, 3.5f}}};
    EXPECT_TRUE(picture.mark_stale(place));
    const std::vector<Window> expected = {{16, 24, 24, 32}, {64, 40, 70, 41}};
    EXPECT_EQ(picture.start_stale_windows(), expected);
    // What was stale has been forgotten, and stays stale until it is finished.
    EXPECT_EQ(picture.start_stale_windows(), expected);
    picture.finish();
    EXPECT_TRUE(picture.mark_stale(place));
    EXPECT_TRUE(picture.start_stale_windows().empty());
    const Box far[] = {{{100, 0, 0}, {101, 1, 1}}};
    EXPECT_FALSE(picture.mark_stale(far));
}

} // namespace relief::cpu
