#include "viewer/orbit_camera.h"
#include "common/vectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief::viewer {

using namespace vectors;

namespace {

/// Angle that stays between the view and the poles.
constexpr float kPoleMargin = 0.01f;

} // namespace

void OrbitCamera::set(const Camera& camera) {
    camera_ = camera;
    if (camera_.from == camera_.to) camera_.to = camera_.from + Vec3f{0, 0, -1};
    const float off = std::fabs(camera_.focus_distance - distance());
    has_focus_at_target_ = camera_.aperture_radius == 0 || off < 1e-3f * distance();
}

Vec3f OrbitCamera::forward() const { return normalize(camera_.to - camera_.from); }

Vec3f OrbitCamera::right() const {
    const Vec3f across = cross(forward(), camera_.up);
    return length(across) > 0 ? normalize(across) : Vec3f{1, 0, 0};
}

Vec3f OrbitCamera::upward() const { return cross(right(), forward()); }

float OrbitCamera::distance() const { return length(camera_.to - camera_.from); }

float OrbitCamera::limit_turn(const Vec3f& direction, float up) const {
    const float elevation = std::asin(std::clamp(dot(direction, normalize(camera_.up)), -1.0f, 1.0f));
    const float most = std::numbers::pi_v<float> / 2 - kPoleMargin;
    return std::clamp(elevation + up, -most, most) - elevation;
}

void OrbitCamera::orbit(float right_angle, float up) {
    const Vec3f arm = camera_.from - camera_.to;
    const float size = length(arm);
    const Vec3f lifted = rotate(arm, right(), -limit_turn(normalize(arm), up));
    const Vec3f turned = rotate(lifted, normalize(camera_.up), right_angle);
    camera_.from = camera_.to + normalize(turned) * size;
}

void OrbitCamera::look(float right_angle, float up) {
    const float size = distance();
    const Vec3f lifted = rotate(forward(), right(), limit_turn(forward(), up));
    camera_.to = camera_.from + normalize(rotate(lifted, normalize(camera_.up), -right_angle)) * size;
}

void OrbitCamera::move(const Vec3f& shift) {
    camera_.from = camera_.from + shift;
    camera_.to = camera_.to + shift;
}

void OrbitCamera::pan(float right_heights, float up_heights) {
    const float height = 2 * distance() * std::tan(camera_.fov_degrees * std::numbers::pi_v<float> / 360);
    move(right() * (right_heights * height) + upward() * (up_heights * height));
}

void OrbitCamera::dolly(float factor) {
    camera_.from = camera_.to - forward() * (distance() * factor);
    keep_focus();
}

void OrbitCamera::fly(float right_units, float up_units, float forward_units) {
    const float unit = distance();
    move(right() * (right_units * unit) + upward() * (up_units * unit) + forward() * (forward_units * unit));
}

void OrbitCamera::focus(const Vec3f& point) {
    move(point - camera_.to);
    has_focus_at_target_ = true;
    keep_focus();
}

void OrbitCamera::set_fov(float degrees) { camera_.fov_degrees = std::clamp(degrees, 1.0f, 170.0f); }

void OrbitCamera::keep_focus() {
    if (has_focus_at_target_) camera_.focus_distance = distance();
}

} // namespace relief::viewer
