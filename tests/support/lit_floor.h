// A floor under lights whose irradiance is known, and such lights.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "support/shading_scenes.h"

namespace relief {

inline constexpr double kPi = std::numbers::pi;
inline constexpr float kAlbedo = 0.6f;

/// A grey floor, seen so narrowly from above that every pixel shows the origin.
inline Scene make_floor_scene() {
    Scene scene;
    add_object(scene, make_floor(10), make_matte(kAlbedo));
    scene.camera.from = {0.5f, 3, 4};
    scene.camera.to = {0, 0, 0};
    scene.camera.fov_degrees = 0.1f;
    return scene;
}

inline void expect_irradiance(Scene scene, double irradiance, int spp, int bounces = 1) {
    const RenderResult result = render(std::move(scene), make_small_settings(8, spp, bounces));
    const Mean mean = compute_covered_mean(result.image);
    const double expected = kAlbedo / kPi * irradiance;
    EXPECT_EQ(mean.pixels, 64u);
    EXPECT_NEAR(mean.value, expected, 2e-3 * expected + 4 * mean.standard_error);
    EXPECT_LT(mean.standard_error, 0.02 * expected + 1e-6);
}

/// Form factor from a point to a parallel rectangle a x b at distance 1 with a corner right above it (Howell,
/// A Catalog of Radiation Heat Transfer Configuration Factors, B-4).
inline double corner_form_factor(double a, double b) {
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * kPi);
}

inline Light make_sun(const Vec3f& direction, float angle_degrees) {
    Light light;
    light.direction = direction;
    light.angle_degrees = angle_degrees;
    light.strength = 3;
    return light;
}

inline Light make_point(const Vec3f& position, float radius) {
    Light light;
    light.type = LightType::point;
    light.position = position;
    light.radius = radius;
    light.strength = 5;
    return light;
}

} // namespace relief
