// Surfaces that scatter and transmit in every way under lights of every kind, in groups; and checks of the
// layers that the light of such pictures is shared out over.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/light_layers.h"
#include "relief/render.h"
#include "support/shading_scenes.h"

namespace relief::test {

/// A ball of glass, a bubble through which the camera sees the disk, and an upright pane of frosted glass.
inline void add_glass(Scene& scene) {
    Material glass;
    glass.transmission_weight = 1, glass.roughness = 0.35f, glass.transmission_color = {0.9f, 0.8f, 0.6f};
    Material bubble = glass, frosted = glass;
    bubble.roughness = 0, bubble.is_thin_walled = true;
    frosted.is_thin_walled = true;
    const auto place = [&](const Vec3f& at, const Material& material) {
        add_object(scene, make_sphere(4, SphereNormals::smooth), material);
        Affine& placed = scene.objects.back().world_from_object;
        for (int k = 0; k < 3; ++k) placed.rows[k] = placed.rows[k] * 0.5f;
        placed.translation = at;
    };
    place({-1.7f, 0.5f, 2.2f}, glass), place({0, 2.8f, 2.5f}, bubble);
    add_object(scene, make_floor(0.5f), frosted);
    scene.objects.back().world_from_object = {{Vec3f{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {-2, 2.2f, 0.5f}};
}

/// "key" is a sun, "rim" a disk that the camera sees, "lamp" a surface, "sky" the environment; a point light
/// is in no group.
inline Scene make_lit_room() {
    Scene scene;
    Material floor = make_matte(0.6f), metal, glossy, lamp = make_matte(0.5f);
    metal.metallic = 1, metal.roughness = 0.4f;
    glossy.roughness = 0.4f, glossy.coat_weight = 0.5f, glossy.fuzz_weight = 0.4f;
    glossy.coat_roughness = 0.4f;
    lamp.emission = {3, 2, 1}, lamp.light_group = "lamp";
    add_object(scene, make_floor(4), floor);
    const auto place = [&](const Vec3f& at, const Material& material) {
        add_object(scene, make_sphere(4, SphereNormals::smooth), material);
        scene.objects.back().world_from_object.translation = at;
    };
    place({-1.2f, 1, 0}, metal), place({1.2f, 1, 0}, glossy);
    add_object(scene, make_floor(0.6f), lamp);
    scene.objects.back().world_from_object.translation = {0, 0.3f, 2};
    add_glass(scene);
    scene.lights.resize(3);
    scene.lights[0].direction = {-1, -2, -1}, scene.lights[0].angle_degrees = 4;
    scene.lights[0].light_group = "key";
    scene.lights[1].type = LightType::disk, scene.lights[1].position = {0, 3.2f, -1};
    scene.lights[1].direction = {0, -0.5f, 1}, scene.lights[1].radius = 0.5f;
    scene.lights[1].strength = 6;
    scene.lights[1].is_visible_to_camera = true, scene.lights[1].light_group = "rim";
    scene.lights[2].type = LightType::point, scene.lights[2].position = {3, 2, 3};
    scene.lights[2].strength = 4;
    scene.environment.emplace().color = {0.2f, 0.3f, 0.5f};
    scene.environment->light_group = "sky";
    scene.camera.from = {0, 2.5f, 8}, scene.camera.to = {0, 1.2f, 0}, scene.camera.fov_degrees = 38;
    return scene;
}

inline const std::vector<std::string> kRoomGroups{"light_default", "light_key", "light_lamp", "light_rim",
                                                  "light_sky"};

inline RenderSettings make_room_settings(int spp) {
    RenderSettings settings;
    settings.image.width = 24, settings.image.height = 18;
    settings.image.spp = spp, settings.image.bounces = 3, settings.image.seed = 4;
    settings.image.layers = {kLightKinds.begin(), kLightKinds.end()};
    settings.image.layers.insert(settings.image.layers.end(), kRoomGroups.begin(), kRoomGroups.end());
    settings.image.layers.push_back("samples");
    return settings;
}

inline Vec3f get_color(const Image& image, size_t pixel, const std::string& layer) {
    const size_t first = image.find_channel(layer.empty() ? "R" : layer + ".R").value();
    const float* values = image.pixels.data() + pixel * image.channels.size() + first;
    return {values[0], values[1], values[2]};
}

/// Mean of the three channels over the picture.
inline double find_mean(const Image& image, const std::string& layer) {
    const size_t count = image.pixels.size() / image.channels.size();
    double sum = 0;
    for (size_t p = 0; p < count; ++p) {
        const Vec3f color = get_color(image, p, layer);
        sum += double(color.x) + double(color.y) + double(color.z);
    }
    return sum / (3 * double(count));
}

/// In every pixel, but for rounding.
template <class Names> void expect_sum_is_color(const Image& image, const Names& layers) {
    for (size_t p = 0; p < image.pixels.size() / image.channels.size(); ++p) {
        Vec3f sum{};
        for (const std::string layer : layers) sum += get_color(image, p, layer);
        const Vec3f color = get_color(image, p, "");
        const float most = 2e-6f * (1 + std::max({color.x, color.y, color.z}));
        ASSERT_NEAR(sum.x, color.x, most) << "pixel " << p;
        ASSERT_NEAR(sum.y, color.y, most) << "pixel " << p;
        ASSERT_NEAR(sum.z, color.z, most) << "pixel " << p;
    }
}

inline void expect_layers_of_light(const Image& image) {
    expect_sum_is_color(image, kLightKinds);
    expect_sum_is_color(image, kRoomGroups);
}

/// R, G, B and A alone.
inline std::vector<float> get_colors(const Image& image) {
    std::vector<float> colors;
    for (size_t k = 0; k < image.pixels.size(); ++k)
        if (k % image.channels.size() < 4) colors.push_back(image.pixels[k]);
    return colors;
}

} // namespace relief::test
