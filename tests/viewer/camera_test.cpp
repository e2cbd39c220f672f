// Cameras moved by hand, what drags mean, and the size of pictures that follow.
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "common/explain_pixel.h"
#include "common/vectors.h"
#include "viewer/navigation.h"
#include "viewer/orbit_camera.h"
#include "viewer/resolution_governor.h"
#include "viewer/surface_point.h"

namespace relief::viewer {

using namespace vectors;

namespace {

void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_NEAR(a.x, b.x, 1e-4f);
    EXPECT_NEAR(a.y, b.y, 1e-4f);
    EXPECT_NEAR(a.z, b.z, 1e-4f);
}

OrbitCamera make_camera() {
    Camera camera;
    camera.from = {0, 0, 5};
    return OrbitCamera(camera);
}

} // namespace

TEST(OrbitCamera, turns_about_its_target_at_the_same_distance) {
    OrbitCamera camera = make_camera();
    camera.orbit(float(M_PI) / 2, 0);
    expect_near(camera.get().from, {5, 0, 0});
    expect_near(camera.get().to, {0, 0, 0});
    camera.orbit(0, 0.5f);
    EXPECT_NEAR(camera.distance(), 5, 1e-4);
    EXPECT_NEAR(camera.get().from.y, 5 * std::sin(0.5f), 1e-4);
}

TEST(OrbitCamera, never_turns_over_a_pole) {
    OrbitCamera camera = make_camera();
    for (int k = 0; k < 20; ++k) camera.orbit(0, 1);
    EXPECT_GT(camera.get().from.y, 4.99f);
    EXPECT_GT(std::hypot(camera.get().from.x, camera.get().from.z), 0.01f);
    EXPECT_GT(camera.get().from.z, 0);
    for (int k = 0; k < 20; ++k) camera.look(0, -1);
    EXPECT_LT(camera.forward().y, -0.99f);
}

TEST(OrbitCamera, looks_around_from_where_it_is) {
    OrbitCamera camera = make_camera();
    camera.look(float(M_PI) / 2, 0);
    expect_near(camera.get().from, {0, 0, 5});
    expect_near(camera.forward(), {1, 0, 0});
}

TEST(OrbitCamera, moves_what_it_sees_by_heights_of_the_picture) {
    OrbitCamera camera = make_camera();
    camera.pan(0, 1);
    const float height = 2 * 5 * std::tan(35 * float(M_PI) / 360);
    expect_near(camera.get().to, {0, height, 0});
    expect_near(camera.get().from, {0, height, 5});
}

TEST(OrbitCamera, comes_nearer_and_keeps_the_focus_on_its_target) {
    OrbitCamera camera = make_camera();
    camera.dolly(0.5f);
    expect_near(camera.get().from, {0, 0, 2.5f});
    EXPECT_NEAR(camera.get().focus_distance, 2.5f, 1e-4);
    camera.focus({1, 2, 3});
    expect_near(camera.get().to, {1, 2, 3});
    expect_near(camera.get().from, {1, 2, 5.5f});
}

TEST(OrbitCamera, flies_along_its_own_axes) {
    OrbitCamera camera = make_camera();
    camera.fly(0, 0, 0.2f);
    expect_near(camera.get().from, {0, 0, 4});
    camera.fly(0.2f, 0, 0);
    expect_near(camera.get().from, {1, 0, 4});
}

TEST(Navigation, drags_mean_what_they_mean_in_other_programs) {
    const auto blender = NavigationPreset::blender, maya = NavigationPreset::maya;
    EXPECT_EQ(choose_action(blender, MouseButton::middle, {}), DragAction::orbit);
    EXPECT_EQ(choose_action(blender, MouseButton::middle, {.shift = true}), DragAction::pan);
    EXPECT_EQ(choose_action(blender, MouseButton::middle, {.control = true}), DragAction::dolly);
    EXPECT_EQ(choose_action(maya, MouseButton::left, {.alt = true}), DragAction::orbit);
    EXPECT_EQ(choose_action(maya, MouseButton::middle, {.alt = true}), DragAction::pan);
    EXPECT_EQ(choose_action(maya, MouseButton::right, {.alt = true}), DragAction::dolly);
    for (const auto preset : {blender, maya}) {
        EXPECT_EQ(choose_action(preset, MouseButton::left, {}), DragAction::tool);
        EXPECT_EQ(choose_action(preset, MouseButton::right, {}), DragAction::look);
        EXPECT_EQ(choose_action(preset, MouseButton::left, {.control = true}), DragAction::focus);
    }
}

TEST(ProjectLine, is_where_the_rays_of_pixels_go) {
    Camera camera;
    camera.from = {1, 2, 5}, camera.to = {0.5f, 0, -1}, camera.shift = {0.1f, -0.2f};
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(31, 7), std::pair(63, 35)}) {
        const Ray ray = cli::make_pixel_ray(camera, 64, 36, x, y);
        const auto line =
            project_line(camera, ray.origin + ray.direction * 2, ray.origin + ray.direction * 9, 64, 36);
        ASSERT_TRUE(line);
        for (const Vec2f& end : {line->first, line->second}) {
            EXPECT_NEAR(end.x, float(x) + 0.5f, 1e-3f);
            EXPECT_NEAR(end.y, float(y) + 0.5f, 1e-3f);
        }
    }
}

TEST(ProjectLine, ends_before_the_camera) {
    Camera camera;
    camera.from = {0, 0, 5};
    EXPECT_FALSE(project_line(camera, {0, 0, 6}, {1, 0, 8}, 64, 36));
    const auto line = project_line(camera, {1, 0, 0}, {1, 0, 10}, 64, 36);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->first.y, 18, 1e-3f);
    EXPECT_GT(line->second.x, 1000);
    EXPECT_TRUE(std::isfinite(line->second.x));
}

TEST(ResolutionGovernor, finds_the_size_that_takes_the_time_it_is_given) {
    ResolutionGovernor governor;
    const double seconds_a_pixel = 5e-7; // the whole picture takes 0.26 s
    for (int k = 0; k < 60; ++k) {
        const auto [width, height] = governor.choose_size(960, 540);
        governor.learn(seconds_a_pixel * width * height);
    }
    const auto [width, height] = governor.choose_size(960, 540);
    EXPECT_NEAR(seconds_a_pixel * width * height, ResolutionGovernor::Config().target_s, 0.004);
}

TEST(ResolutionGovernor, stays_between_its_least_size_and_the_whole_picture) {
    ResolutionGovernor governor;
    for (int k = 0; k < 100; ++k) governor.learn(1e-4);
    EXPECT_EQ(governor.choose_size(960, 540), std::pair(960, 540));
    for (int k = 0; k < 100; ++k) governor.learn(100);
    EXPECT_EQ(governor.choose_size(960, 540), std::pair(60, 34));
    EXPECT_EQ(governor.choose_size(3, 1), std::pair(1, 1));
}

} // namespace relief::viewer
