// Textures of rectangles and disks: how much light they let through, and which way up cameras see them.
#include <gtest/gtest.h>

#include "support/lit_floor.h"

namespace relief {
namespace {

/// Grey by columns and rows of `width` times `height` texels.
template <class Value>
std::shared_ptr<const Texture> make_texture(uint32_t width, uint32_t height, const Value& value) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) texture->floats.push_back(value(x, y));
    return texture;
}

Light make_light(LightType type, const Vec3f& position, const Vec3f& direction) {
    Light light = make_point(position, 0.5f);
    light.type = type, light.direction = direction;
    return light;
}

TEST(TexturedLights, shine_where_their_texture_is_bright) {
    for (const bool is_left : {true, false})
        for (const int bounces : {0, 1}) {
            Scene scene = make_floor_scene();
            Light light = make_light(LightType::rectangle, {0.5f, 1, 0}, {0, -1, 0});
            light.width = 3, light.height = 2;
            // From below, with -z above, the left half is the one towards +x: 0.5 to 2.
            light.color_texture = make_texture(
                512, 1, [&](uint32_t x, uint32_t) { return (x < 256) == is_left ? 2.0f : 0.0f; });
            scene.lights = {light};
            const double radiance = 2 * 5.0 / 6, half = corner_form_factor(0.5, 1);
            const double lit = is_left ? corner_form_factor(2, 1) - half : corner_form_factor(1, 1) + half;
            expect_irradiance(std::move(scene), radiance * kPi * 2 * lit, 1024, bounces);
        }
}

TEST(TexturedLights, of_white_are_those_without_a_texture) {
    for (const LightType type : {LightType::rectangle, LightType::disk}) {
        Scene scene = make_floor_scene();
        scene.lights = {make_light(type, {0, 1, 0}, {0.1f, -1, 0.2f})};
        scene.lights[0].color = {0.5f, 1, 0.25f};
        const double plain = compute_covered_mean(render(scene, make_small_settings(8, 256, 1)).image).value;
        scene.lights[0].color_texture = make_texture(3, 2, [](uint32_t, uint32_t) { return 1.0f; });
        const double white = compute_covered_mean(render(scene, make_small_settings(8, 256, 1)).image).value;
        EXPECT_NEAR(white, plain, 2e-3 * plain) << int(type);
    }
}

TEST(TexturedLights, are_seen_upright_from_where_they_shine) {
    // The top left texel is the brightest, then those to its right, and below.
    const auto numbers = make_texture(2, 2, [](uint32_t x, uint32_t y) { return 1.0f + float(x + 2 * y); });
    for (const LightType type : {LightType::rectangle, LightType::disk}) {
        Scene scene;
        add_object(scene, make_floor(1), make_matte(0));
        scene.objects[0].world_from_object.translation.y = -50;
        Light light = make_light(type, {0, 1, 0}, {0, 0, 1});
        light.is_visible_to_camera = true, light.color_texture = numbers;
        scene.camera.from = {0, 1, 5}, scene.camera.to = {0, 1, 0}, scene.camera.fov_degrees = 10;
        const double radiance = 5 / (type == LightType::disk ? kPi * 0.25 : 1.0);
        const auto expect_at = [&](const Vec3f& up, int x, int y, double value) {
            light.up = up;
            scene.lights = {light};
            const Image image = render(scene, make_small_settings(32, 4, 0)).image;
            EXPECT_NEAR(image.at(x, y, image.find_channel("G").value()), value * radiance, 0.2 * radiance)
                << x << ' ' << y << ' ' << int(type);
        };
        // Near the centres of texels.
        expect_at({0, 1, 0}, 6, 6, 1), expect_at({0, 1, 0}, 25, 6, 2);
        expect_at({0, 1, 0}, 6, 25, 3), expect_at({0, 1, 0}, 25, 25, 4);
        expect_at({1, 0, 0}, 25, 6, 1), expect_at({1, 0, 0}, 25, 25, 2); // its top is to the right
        // Black is as opaque as white.
        light.color_texture = make_texture(2, 2, [](uint32_t x, uint32_t) { return float(x); });
        scene.lights = {light};
        const Image image = render(scene, make_small_settings(32, 4, 0)).image;
        EXPECT_EQ(image.at(11, 16, image.find_channel("A").value()), 1);
        light.color_texture = numbers;
    }
}

TEST(TexturedLights, do_not_bleed_from_one_edge_to_the_other) {
    Scene scene = make_floor_scene();
    Light light = make_light(LightType::rectangle, {0, 1, 0}, {0, 0, 1});
    light.is_visible_to_camera = true;
    light.color_texture = make_texture(4, 1, [](uint32_t x, uint32_t) { return x == 0 ? 1.0f : 0.0f; });
    scene.lights = {light};
    scene.camera.from = {0.49f, 1, 2}, scene.camera.to = {0.49f, 1, 0};
    const Image image = render(scene, make_small_settings(4, 4, 0)).image;
    EXPECT_EQ(image.at(2, 2, image.find_channel("G").value()), 0);
}

} // namespace
} // namespace relief
