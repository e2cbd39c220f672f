// A green wall that the camera sees in something or through it, and what the guides of a denoiser are there.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "relief/denoise.h"
#include "relief/render.h"
#include "support/shading_scenes.h"

namespace relief::test {

inline constexpr Vec3f kWallColor{0.2f, 0.6f, 0.4f}, kSkyColor{0.05f, 0.1f, 0.3f};

/// Where the wall is, seen from a quad in front of the camera that faces it or is turned towards the wall.
enum class Wall { behind, beside };

/// The camera looks along -z at a quad of this material. No light but a plain sky.
inline Scene make_shown_wall(const Material& front, Wall wall) {
    Scene scene;
    // Turned, its normal is halfway between the directions to the camera and to the wall.
    const Vec3f right = wall == Wall::beside ? Vec3f{0.7f, 0, -0.7f} : Vec3f{1, 0, 0};
    add_object(scene,
               make_quad_mesh({Vec3f{-right.x, -1, -right.z},
                               {right.x, -1, right.z},
                               {right.x, 1, right.z},
                               {-right.x, 1, -right.z}}),
               front);
    Material green = make_matte(1);
    green.base_color = kWallColor;
    if (wall == Wall::beside)
        add_object(scene, make_quad_mesh({Vec3f{3, -4, -4}, {3, -4, 4}, {3, 4, 4}, {3, 4, -4}}), green);
    else
        add_object(scene, make_quad_mesh({Vec3f{-4, -4, -3}, {4, -4, -3}, {4, 4, -3}, {-4, 4, -3}}), green);
    scene.environment.emplace().color = kSkyColor;
    scene.camera.from = {0, 0, 5}, scene.camera.to = {}, scene.camera.fov_degrees = 4;
    return scene;
}

/// With all guides; `albedo` and `N` beside them.
inline RenderSettings make_guide_settings(int spp) {
    RenderSettings settings = make_small_settings(6, spp, 4);
    settings.image.layers = {"albedo", "N"};
    for (const char* guide : kDenoiserGuides) settings.image.layers.emplace_back(guide);
    return settings;
}

/// Mean over the picture of the three channels of a layer, whose first has this name.
inline Vec3f find_mean_of(const Image& image, const std::string& first_channel) {
    const size_t first = image.find_channel(first_channel).value(), width = image.channels.size();
    Vec3<double> sum{};
    for (size_t k = first; k < image.pixels.size(); k += width)
        sum.x += double(image.pixels[k]), sum.y += double(image.pixels[k + 1]),
            sum.z += double(image.pixels[k + 2]);
    const double count = double(image.pixels.size() / width);
    return {float(sum.x / count), float(sum.y / count), float(sum.z / count)};
}

inline void expect_near(const Vec3f& found, const Vec3f& expected, float most) {
    EXPECT_NEAR(found.x, expected.x, most);
    EXPECT_NEAR(found.y, expected.y, most);
    EXPECT_NEAR(found.z, expected.z, most);
}

inline Material make_mirror(const Vec3f& color, float roughness) {
    Material mirror;
    mirror.metallic = 1, mirror.roughness = roughness, mirror.base_color = color;
    return mirror;
}

inline Material make_pane(float roughness) {
    Material pane;
    pane.transmission_weight = 1, pane.is_thin_walled = true, pane.roughness = roughness;
    return pane;
}

} // namespace relief::test
