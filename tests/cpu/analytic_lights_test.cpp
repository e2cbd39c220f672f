// Scenes whose radiance is known in closed form.
#include <gtest/gtest.h>

#include "support/lit_floor.h"

namespace relief {
namespace {

TEST(AnalyticLights, sun_gives_strength_times_cosine) {
    for (float angle : {0.0f, 0.53f, 20.0f}) {
        Scene scene = make_floor_scene();
        scene.lights = {make_sun({-1, -2, 0.5f}, angle)};
        expect_irradiance(std::move(scene), 3 * 2 / std::sqrt(5.25), 32);
    }
}

TEST(AnalyticLights, sun_below_the_horizon_gives_nothing) {
    Scene scene = make_floor_scene();
    scene.lights = {make_sun({0, 1, 0.1f}, 0.53f)};
    const Mean mean = compute_covered_mean(render(std::move(scene), make_small_settings(8, 8, 2)).image);
    EXPECT_EQ(mean.value, 0);
}

TEST(AnalyticLights, point_light_falls_with_the_square_of_the_distance) {
    for (float height : {1.0f, 2.0f, 4.0f}) {
        Scene scene = make_floor_scene();
        scene.lights = {make_point({0, height, 0}, 0)};
        expect_irradiance(std::move(scene), 5 / (height * height), 16);
    }
    Scene scene = make_floor_scene();
    scene.lights = {make_point({1, 1, 0}, 0)};
    expect_irradiance(std::move(scene), 5 / 2.0 / std::sqrt(2.0), 16);
}

TEST(AnalyticLights, sphere_light_above_the_horizon_equals_its_centre) {
    for (float radius : {0.1f, 0.5f, 0.9f}) {
        Scene scene = make_floor_scene();
        scene.lights = {make_point({0, 1, 0}, radius)};
        expect_irradiance(std::move(scene), 5, 64);
        scene = make_floor_scene();
        scene.lights = {make_point({-1, 1, 0}, radius)};
        expect_irradiance(std::move(scene), 5 / 2.0 / std::sqrt(2.0), 64);
    }
}

TEST(AnalyticLights, a_lamp_shines_in_front_of_a_wall_as_in_front_of_nothing) {
    Scene scene = make_floor_scene();
    scene.lights = {make_point({0, 1.5f, 0}, 1.2f)};
    add_object(scene, make_floor(10), make_matte(0));
    scene.objects.back().world_from_object.translation = {0, 8, 0};
    expect_irradiance(std::move(scene), 5 / (1.5 * 1.5), 64);
}

TEST(AnalyticLights, two_lights_add_up_whatever_their_shares) {
    Scene scene = make_floor_scene();
    scene.lights = {make_point({0, 1, 0}, 0.2f), make_point({0, 3, 0}, 0), make_sun({0, -1, 0}, 1)};
    expect_irradiance(std::move(scene), 5 + 5 / 9.0 + 3, 256);
}

TEST(AnalyticLights, glowing_quad_has_its_form_factor) {
    for (float half : {0.2f, 1.0f, 3.0f})
        for (int bounces : {0, 1}) {
            Scene scene = make_floor_scene();
            scene.camera.from = {0.5f, 0.5f, 0.3f}; // below the quad
            Material glow = make_matte(0);
            glow.emission = {2, 2, 2};
            const Vec3f corners[4] = {{-half, 1, -half}, {half, 1, -half}, {half, 1, half}, {-half, 1, half}};
            add_object(scene, make_quad_mesh({corners[0], corners[1], corners[2], corners[3]}), glow);
            expect_irradiance(std::move(scene), 2 * kPi * 4 * corner_form_factor(half, half), 256, bounces);
        }
}

TEST(AnalyticLights, glowing_triangle_pair_equals_the_quad) {
    Scene scene = make_floor_scene();
    scene.camera.from = {0.5f, 0.5f, 0.3f};
    Material glow = make_matte(0);
    glow.emission = {2, 2, 2};
    Mesh mesh = make_quad_mesh({Vec3f{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
    mesh.face_sizes = {3, 3};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 0, 2, 3};
    add_object(scene, std::move(mesh), glow);
    expect_irradiance(std::move(scene), 2 * kPi * 4 * corner_form_factor(1, 1), 256);
}

/// Environment that is 1 where `is_lit` says so of the column and row, else 0.
template <class Predicate>
std::shared_ptr<Texture> make_environment(uint32_t width, uint32_t height, float value, Predicate is_lit) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) texture->floats.push_back(is_lit(x, y) ? value : 0.0f);
    return texture;
}

TEST(AnalyticLights, constant_environment_gives_pi) {
    Scene scene = make_floor_scene();
    scene.environment = Environment{};
    expect_irradiance(std::move(scene), kPi, 128);
}

TEST(AnalyticLights, one_bright_texel_gives_its_solid_angle_with_little_noise) {
    // Texel row 15 of 64: centre 43.6 degrees from the zenith. The bilinear tent keeps the texel's integral.
    constexpr uint32_t width = 128, height = 64;
    Scene scene = make_floor_scene();
    scene.environment = Environment{};
    scene.environment->texture =
        make_environment(width, height, 1000, [](uint32_t x, uint32_t y) { return x == 70 && y == 15; });
    double irradiance = 0;
    constexpr int fine = 200; // integral of tent(y) sin cos over the texel and its neighbours
    for (int k = 0; k < fine; ++k) {
        const double offset = 2 * (k + 0.5) / fine - 1;
        const double theta = (15.5 + offset) * kPi / height;
        irradiance += (1 - std::fabs(offset)) * std::sin(theta) * std::cos(theta) * 2 / fine;
    }
    irradiance *= 1000 * (kPi / height) * (2 * kPi / width);
    expect_irradiance(std::move(scene), irradiance, 256);
}

TEST(AnalyticLights, environment_stands_where_the_conventions_say) {
    // A bright quarter around +x (three quarters to the right of the image); 90 degrees about +y bring it to
    // -z.
    for (float turn : {0.0f, 90.0f, 180.0f, -90.0f}) {
        const double angle = turn * kPi / 180;
        const Vec3f bright{float(std::cos(angle)), 0, float(-std::sin(angle))};
        for (float side : {1.0f, -1.0f}) {
            Scene scene = make_floor_scene();
            scene.environment = Environment{};
            scene.environment->rotate_degrees = turn;
            scene.environment->texture =
                make_environment(64, 32, 1, [](uint32_t x, uint32_t) { return x >= 40 && x < 56; });
            scene.camera.from = {0, 1, 0};
            scene.camera.to = Vec3f{0, 1, 0} + bright * side;
            scene.camera.fov_degrees = 5;
            const Image image = render(std::move(scene), make_small_settings(8, 4, 0)).image;
            EXPECT_NEAR(image.at(4, 4, 0), side > 0 ? 1 : 0, 1e-5) << turn;
            EXPECT_EQ(image.at(4, 4, 3), 0);
        }
    }
}

TEST(AnalyticLights, darkness_is_black) {
    const Mean mean = compute_covered_mean(render(make_floor_scene(), make_small_settings(8, 4, 3)).image);
    EXPECT_EQ(mean.value, 0);
}

} // namespace
} // namespace relief
