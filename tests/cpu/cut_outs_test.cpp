// Surfaces of partial opacity: what passes them, on the way from the camera, to lights and between bounces.
#include <vector>

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

/// A displaced body with automatic levels on a floor, lit from all sides and by a sun.
Scene make_body(const Material& material) {
    Scene scene;
    add_object(scene, test::make_cube_sphere(3), material);
    scene.objects.back().displacement = 0;
    scene.displacements.push_back(
        test::make_displacement(test::make_random_map(64, 48, 0.1f, 3), DisplacementSpace::object));
    add_object(scene, make_floor(3), make_matte(0.5f));
    scene.objects.back().world_from_object.translation = {0, -1.2f, 0};
    scene.environment = Environment{};
    scene.lights.push_back({.type = LightType::sun, .direction = {-1, -2, -1}, .angle_degrees = 5});
    scene.camera.from = {0.5f, 1, 4};
    return scene;
}

/// In cells so small that bounce rays see a coarser surface within the scene.
std::vector<float> render_pixels(Scene scene, int bounces) {
    RenderSettings settings = make_small_settings(24, 4, bounces);
    settings.surface.pixel_error = 0.05f;
    return render(std::move(scene), settings).image.pixels;
}

TEST(CutOuts, that_stop_nothing_are_not_there_and_those_that_stop_all_are_opaque) {
    Material opaque = make_matte(0.8f), absent = opaque, whole = opaque;
    absent.opacity = 0;
    set_input_texture(whole, MaterialInput::opacity, make_number_texture(1));
    Scene bare = make_body(opaque);
    bare.objects.erase(bare.objects.begin());
    EXPECT_EQ(render_pixels(make_body(absent), 3), render_pixels(bare, 3));
    EXPECT_EQ(render_pixels(make_body(whole), 3), render_pixels(make_body(opaque), 3));
}

TEST(CutOuts, by_texture_are_as_by_number) {
    Material number = make_matte(0.8f), texture = number;
    number.opacity = 0.25f;
    texture.opacity = 0.5f;
    set_input_texture(texture, MaterialInput::opacity, make_number_texture(0.5f));
    EXPECT_EQ(render_pixels(make_body(texture), 2), render_pixels(make_body(number), 2));
    EXPECT_NE(render_pixels(make_body(number), 2), render_pixels(make_body(make_matte(0.8f)), 2));
}

/// `opacities` of sheets one behind the other, black, before a camera that sees nothing else.
double measure_background(const std::vector<float>& opacities, double& alpha) {
    Scene scene;
    for (size_t k = 0; k < opacities.size(); ++k) {
        Material black = make_matte(0);
        black.opacity = opacities[k];
        add_object(scene, make_floor(50), black);
        scene.objects.back().world_from_object.translation = {0, -float(k), 0};
    }
    scene.environment = Environment{};
    scene.camera.from = {0, 5, 0}, scene.camera.to = {0, 0, 0}, scene.camera.up = {0, 0, 1};
    const Image image = render(std::move(scene), make_small_settings(8, 1024, 0)).image;
    double sum = 0;
    alpha = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            sum += double(image.at(x, y, 1)) / 64, alpha += double(image.at(x, y, 3)) / 64;
    return sum;
}

TEST(CutOuts, let_through_what_their_opacities_leave_together) {
    double alpha = 0;
    EXPECT_NEAR(measure_background({0.3f}, alpha), 0.7, 0.004);
    EXPECT_NEAR(alpha, 0.3, 0.004);
    EXPECT_NEAR(measure_background({0.3f, 0.5f, 0.2f}, alpha), 0.7 * 0.5 * 0.8, 0.006);
    EXPECT_NEAR(alpha, 1 - 0.7 * 0.5 * 0.8, 0.006);
}

double measure_floor(const std::vector<float>& opacities) {
    Scene scene;
    add_object(scene, make_floor(2), make_matte(0.5f));
    for (size_t k = 0; k < opacities.size(); ++k) {
        Material sheet = make_matte(0);
        sheet.opacity = opacities[k];
        add_object(scene, make_floor(20), sheet);
        scene.objects.back().world_from_object.translation = {0, 10 + float(k), 0};
    }
    scene.lights.push_back({.type = LightType::sun, .direction = {0, -1, 0}, .angle_degrees = 0});
    scene.camera.from = {0, 3, 3}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 20;
    const RenderResult result = render(std::move(scene), make_small_settings(8, 1024, 0));
    return compute_covered_mean(result.image).value;
}

TEST(CutOuts, between_a_light_and_a_surface_take_their_part_of_it) {
    const double bare = measure_floor({});
    EXPECT_NEAR(measure_floor({0.25f}) / bare, 0.75, 0.005);
    EXPECT_NEAR(measure_floor({0.25f, 0.6f}) / bare, 0.3, 0.007);
    EXPECT_EQ(measure_floor({1}), 0);
}

/// White inside and outside: whatever passes or stays, all light comes back.
TEST(CutOuts, of_a_white_sphere_are_invisible_in_a_furnace) {
    Material white = make_matte(1);
    white.opacity = 0.5f;
    Scene scene;
    add_object(scene, make_sphere(8, SphereNormals::facets), white);
    scene.environment = Environment{};
    scene.camera.from = {0.5f, 1, 4}, scene.camera.fov_degrees = 20;
    const Image image = render(std::move(scene), make_small_settings(16, 256, 64)).image;
    double sum = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) sum += double(image.at(x, y, 1)) / 256;
    EXPECT_NEAR(sum, 1, 0.004);
}

} // namespace
} // namespace relief
