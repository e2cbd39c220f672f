#include "prepare/camera_frame.h"
#include "formulas/camera.h"

#include <numbers>

namespace relief {

scalar::CameraFrame make_camera_frame(const PreparedScene& scene) {
    const Camera& camera = scene.camera;
    const float fov = camera.fov_degrees * std::numbers::pi_v<float> / 180;
    scalar::CameraFrame frame = scalar::make_camera_frame(camera.from, camera.to, camera.up, fov,
                                                          {float(scene.width), float(scene.height)});
    if (camera.shift != Vec2f{})
        frame.corner = frame.corner + frame.step_x * (camera.shift.x * float(scene.height)) -
                       frame.step_y * (camera.shift.y * float(scene.height));
    frame.aperture_radius = camera.aperture_radius;
    frame.focus_distance = camera.focus_distance;
    return frame;
}

} // namespace relief
