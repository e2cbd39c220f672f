// Textures of materials multiply their numbers.
#include <vector>

#include <gtest/gtest.h>

#include "support/shading_scenes.h"

namespace relief {
namespace {

std::vector<float> render_pixels(const Material& material) {
    Scene scene;
    add_object(scene, make_sphere(12, SphereNormals::smooth), material);
    scene.environment = Environment{};
    scene.environment->color = {1, 0.5f, 0.25f};
    scene.camera.from = {0.5f, 1, 4};
    return render(std::move(scene), make_small_settings(16, 4, 2)).image.pixels;
}

void expect_factors(const Material& plain) {
    Material by_number = plain, by_texture = plain, unchanged = plain;
    by_number.metallic = 0.25f * plain.metallic, by_number.roughness = 0.5f * plain.roughness;
    by_texture.metallic_texture = make_number_texture(0.25f),
    by_texture.roughness_texture = make_number_texture(0.5f);
    EXPECT_EQ(render_pixels(by_texture), render_pixels(by_number));
    unchanged.metallic_texture = make_number_texture(1);
    EXPECT_EQ(render_pixels(unchanged), render_pixels(plain));
    EXPECT_NE(render_pixels(by_number), render_pixels(plain));
    Material beyond = plain;
    beyond.metallic = 1, beyond.metallic_texture = make_number_texture(7);
    Material whole = plain;
    whole.metallic = 1;
    EXPECT_EQ(render_pixels(beyond), render_pixels(whole)) << "limited to [0, 1]";
}

TEST(MaterialTextures, multiply_roughness_and_metallic) {
    Material metal;
    metal.base_color = {0.9f, 0.6f, 0.3f}, metal.metallic = 1, metal.roughness = 0.5f;
    expect_factors(metal);
}

/// Rests of layers are between rows of roughness where that is textured: there the metal alone is compared.
TEST(MaterialTextures, multiply_the_metallic_of_a_base_under_layers) {
    Material coated;
    coated.base_color = {0.9f, 0.6f, 0.3f}, coated.metallic = 1, coated.coat_weight = 0.5f;
    Material by_number = coated, by_texture = coated;
    by_number.metallic = 0.25f, by_texture.metallic_texture = make_number_texture(0.25f);
    EXPECT_EQ(render_pixels(by_texture), render_pixels(by_number));
    EXPECT_NE(render_pixels(by_number), render_pixels(coated));
}

} // namespace
} // namespace relief
