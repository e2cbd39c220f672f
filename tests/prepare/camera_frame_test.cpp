// The frame of a scene's camera.
#include "prepare/camera_frame.h"

#include <gtest/gtest.h>

#include "math/vec.h"

namespace relief {
namespace {

PreparedScene make_view(int width, int height, const Vec2f& shift) {
    PreparedScene scene;
    scene.camera.from = {1, 2, 5}, scene.camera.to = {0.5f, 0, 0}, scene.camera.fov_degrees = 40;
    scene.camera.shift = shift;
    scene.width = width, scene.height = height;
    return scene;
}

void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_NEAR(a.x, b.x, 1e-6);
    EXPECT_NEAR(a.y, b.y, 1e-6);
    EXPECT_NEAR(a.z, b.z, 1e-6);
}

TEST(SceneCamera, with_a_shift_to_the_right_sees_the_right_of_a_wider_picture) {
    const scalar::CameraFrame wide = make_camera_frame(make_view(200, 100, {}));
    const scalar::CameraFrame shifted = make_camera_frame(make_view(120, 100, {0.4f, 0}));
    expect_near(shifted.step_x, wide.step_x);
    expect_near(shifted.corner, wide.corner + wide.step_x * 80.0f);
}

TEST(SceneCamera, with_a_shift_upwards_sees_a_part_above) {
    const scalar::CameraFrame plain = make_camera_frame(make_view(120, 100, {}));
    const scalar::CameraFrame shifted = make_camera_frame(make_view(120, 100, {0, 0.25f}));
    expect_near(shifted.corner, plain.corner - plain.step_y * 25.0f);
    expect_near(shifted.forward, plain.forward);
}

} // namespace
} // namespace relief
