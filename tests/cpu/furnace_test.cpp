// In a furnace every surface that absorbs nothing is invisible: it looks like its surroundings.
#include <gtest/gtest.h>

#include "support/shading_scenes.h"
#include "support/textured_materials.h"

namespace relief {
namespace {

Scene make_furnace(const Material& material, SphereNormals normals) {
    Scene scene;
    add_object(scene, make_sphere(12, normals), material);
    scene.environment = Environment{};
    scene.camera.from = {0.5f, 1, 4};
    scene.camera.fov_degrees = 32;
    return scene;
}

TEST(Furnace, white_matte_sphere_is_invisible) {
    for (SphereNormals normals : {SphereNormals::facets, SphereNormals::smooth}) {
        const Mean mean = render_mean(make_furnace(make_matte(1), normals), make_small_settings(32, 64, 4));
        EXPECT_GT(mean.pixels, 300u);
        EXPECT_NEAR(mean.value, 1, 0.004 + 4 * mean.standard_error);
        EXPECT_LT(mean.standard_error, 0.005);
    }
}

TEST(Furnace, grey_matte_sphere_shows_its_albedo) {
    const Mean mean =
        render_mean(make_furnace(make_matte(0.5f), SphereNormals::facets), make_small_settings(32, 64, 2));
    EXPECT_NEAR(mean.value, 0.5, 0.002 + 4 * mean.standard_error);
}

TEST(Furnace, white_metal_of_any_roughness_is_invisible) {
    for (float roughness : {0.0f, 0.15f, 0.4f, 0.7f, 1.0f}) {
        Material metal;
        metal.base_color = {1, 1, 1};
        metal.metallic = 1;
        metal.roughness = roughness;
        const Mean mean =
            render_mean(make_furnace(metal, SphereNormals::facets), make_small_settings(32, 64, 4));
        EXPECT_NEAR(mean.value, 1, 0.01 + 4 * mean.standard_error) << roughness;
        EXPECT_LT(mean.standard_error, 0.01) << roughness;
    }
}

TEST(Furnace, white_base_under_a_coat_is_invisible) {
    for (float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
        Material coated;
        coated.base_color = {1, 1, 1};
        coated.roughness = roughness;
        const Mean mean =
            render_mean(make_furnace(coated, SphereNormals::smooth), make_small_settings(32, 64, 4));
        EXPECT_NEAR(mean.value, 1, 0.015 + 4 * mean.standard_error) << roughness;
    }
}

TEST(Furnace, white_stack_of_layers_is_invisible) {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.4f, 1.0f}) {
            Material stack;
            stack.base_color = {1, 1, 1}, stack.roughness = roughness, stack.metallic = metallic;
            stack.base_diffuse_roughness = roughness;
            stack.coat_weight = 0.8f, stack.coat_roughness = 0.3f * roughness;
            stack.fuzz_weight = 0.7f;
            const Mean mean =
                render_mean(make_furnace(stack, SphereNormals::smooth), make_small_settings(32, 64, 4));
            EXPECT_NEAR(mean.value, 1, 0.01 + 4 * mean.standard_error) << metallic << ' ' << roughness;
            EXPECT_LT(mean.standard_error, 0.01);
        }
}

TEST(Furnace, white_with_a_direction_is_invisible) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.3f, 0.7f}) {
            Material brushed;
            brushed.base_color = {1, 1, 1}, brushed.roughness = roughness, brushed.metallic = metallic;
            brushed.specular_roughness_anisotropy = 0.8f;
            brushed.coat_weight = 0.6f, brushed.coat_roughness = 0.5f,
            brushed.coat_roughness_anisotropy = 0.9f;
            Scene scene = make_furnace(brushed, SphereNormals::smooth);
            scene.meshes[0] = make_uv_sphere();
            const Mean mean = render_mean(std::move(scene), make_small_settings(32, 64, 4));
            EXPECT_NEAR(mean.value, 1, 0.01 + 4 * mean.standard_error) << metallic << ' ' << roughness;
            EXPECT_LT(mean.standard_error, 0.01);
        }
}

TEST(Furnace, base_weight_is_a_factor_of_the_base) {
    Material grey = make_matte(0.8f);
    grey.base_weight = 0.5f;
    const Mean mean = render_mean(make_furnace(grey, SphereNormals::facets), make_small_settings(32, 64, 2));
    EXPECT_NEAR(mean.value, 0.4, 0.002 + 4 * mean.standard_error);
}

TEST(Furnace, environment_image_of_one_colour_equals_the_constant_one) {
    Scene scene = make_furnace(make_matte(0.8f), SphereNormals::facets);
    auto texture = std::make_shared<Texture>();
    texture->width = 16, texture->height = 8, texture->channel_count = 3;
    texture->floats.assign(4 * 16 * 8, 1.0f);
    scene.environment->texture = texture;
    const Mean mean = render_mean(std::move(scene), make_small_settings(32, 64, 2));
    EXPECT_NEAR(mean.value, 0.8, 0.003 + 4 * mean.standard_error);
}

Scene make_glowing_hollow_sphere(double emission, double albedo) {
    Material wall = make_matte(float(albedo));
    wall.emission = {float(emission), float(emission), float(emission)};
    Scene scene;
    add_object(scene, make_sphere(8, SphereNormals::facets), wall);
    scene.camera.from = {0.2f, 0.1f, 0.3f};
    scene.camera.to = {0, 0, -1};
    scene.camera.fov_degrees = 60;
    return scene;
}

TEST(Furnace, clamped_indirect_light_leaves_emission_and_direct_light) {
    const double e = 0.7, a = 0.6;
    RenderSettings settings = make_small_settings(24, 128, 4);
    settings.image.clamp_indirect = 1e-6f;
    const Mean direct = render_mean(make_glowing_hollow_sphere(e, a), settings);
    EXPECT_NEAR(direct.value, e * (1 + a), 0.004 + 4 * direct.standard_error);
    settings.image.clamp_indirect = 1e6f;
    const Mean all = render_mean(make_glowing_hollow_sphere(e, a), settings);
    EXPECT_NEAR(all.value, e * (1 - std::pow(a, 6)) / (1 - a), 0.008 + 4 * all.standard_error);
}

TEST(Furnace, glowing_hollow_sphere_sums_up_the_series_of_its_bounces) {
    // Radiance e (1 + a + ... + a^(N+1)) with N bounces: each vertex adds the direct light of the wall.
    const double e = 0.7, a = 0.6;
    for (int bounces : {0, 1, 4}) {
        Scene scene = make_glowing_hollow_sphere(e, a);
        const Mean mean = render_mean(std::move(scene), make_small_settings(24, 128, bounces));
        EXPECT_EQ(mean.pixels, 24u * 24u);
        const double expected = e * (1 - std::pow(a, bounces + 2)) / (1 - a);
        EXPECT_NEAR(mean.value, expected, 0.004 * expected + 4 * mean.standard_error) << bounces;
        EXPECT_LT(mean.standard_error, 0.01 * expected);
    }
}

} // namespace
} // namespace relief
