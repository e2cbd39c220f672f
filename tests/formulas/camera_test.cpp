#include <gtest/gtest.h>

#include "formulas/camera.h"
#include "statistics.h"

namespace relief {
namespace {

scalar::CameraFrame make_test_camera() {
    return scalar::make_camera_frame({1, 2, 5}, {0.5f, 0, -1}, {0, 1, 0}, 0.7f, {640, 360});
}

TEST(Camera, projects_a_point_of_a_ray_back_to_its_pixel) {
    const scalar::CameraFrame camera = make_test_camera();
    Random random(1);
    for (int k = 0; k < 1000; ++k) {
        const Vec2f pixel{random.next() * 640, random.next() * 360};
        const scalar::CameraRay ray = scalar::make_camera_ray(camera, pixel, random.next_pair());
        ASSERT_NEAR(length(ray.direction), 1, 1e-6);
        const auto back =
            scalar::project_point(camera, ray.origin + ray.direction * (1 + 20 * random.next()));
        ASSERT_NEAR(back.x, pixel.x, 2e-3);
        ASSERT_NEAR(back.y, pixel.y, 2e-3);
        ASSERT_GT(back.distance, 0);
    }
}

TEST(Camera, sends_pinhole_rays_where_a_closed_lens_sends_them) {
    const scalar::CameraFrame camera = make_test_camera();
    Random random(3);
    for (int k = 0; k < 100; ++k) {
        const Vec2f pixel{random.next() * 640, random.next() * 360};
        const scalar::CameraRay pinhole = scalar::make_pinhole_ray(camera, pixel);
        const scalar::CameraRay lens = scalar::make_camera_ray(camera, pixel, random.next_pair());
        EXPECT_EQ(pinhole.origin, lens.origin);
        EXPECT_LT(length(pinhole.direction - lens.direction), 3e-7f);
    }
}

TEST(Camera, looks_along_the_view_axis_with_up_up_and_right_right) {
    const scalar::CameraFrame camera =
        scalar::make_camera_frame({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1, {100, 50});
    const Vec3f middle = scalar::make_camera_ray(camera, {50, 25}, {0.5f, 0.5f}).direction;
    EXPECT_NEAR(middle.z, -1, 1e-6);
    EXPECT_GT(scalar::make_camera_ray(camera, {50, 0}, {0.5f, 0.5f}).direction.y, 0.1f);
    EXPECT_GT(scalar::make_camera_ray(camera, {100, 25}, {0.5f, 0.5f}).direction.x, 0.1f);
}

TEST(Camera, opens_vertically_by_the_field_of_view) {
    const scalar::CameraFrame camera = make_test_camera();
    const Vec3f top = scalar::make_camera_ray(camera, {320, 0}, {0.5f, 0.5f}).direction;
    const Vec3f bottom = scalar::make_camera_ray(camera, {320, 360}, {0.5f, 0.5f}).direction;
    EXPECT_NEAR(std::acos(dot(top, bottom)), 0.7, 1e-5);
}

TEST(Camera, sends_all_rays_of_a_pixel_through_one_point_in_focus) {
    scalar::CameraFrame camera = make_test_camera();
    camera.aperture_radius = 0.3f;
    camera.focus_distance = 4;
    Random random(2);
    const Vec2f pixel{100.5f, 200.25f};
    const scalar::CameraRay center = scalar::make_camera_ray(camera, pixel, {0.5f, 0.5f});
    const Vec3f focus = center.origin + center.direction * (4 / dot(center.direction, camera.forward));
    for (int k = 0; k < 100; ++k) {
        const scalar::CameraRay ray = scalar::make_camera_ray(camera, pixel, random.next_pair());
        ASSERT_LE(length(ray.origin - camera.origin), 0.3f + 1e-6f);
        ASSERT_NEAR(length(cross(focus - ray.origin, ray.direction)), 0, 1e-5);
    }
}

} // namespace
} // namespace relief
