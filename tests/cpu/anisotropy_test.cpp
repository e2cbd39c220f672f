// Materials whose roughness has a direction: energy, reciprocity and densities of their layers with the
// tables that the engines read; highlights that follow the uvs.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "formulas/hemisphere.h"
#include "formulas/statistics.h"
#include "support/layered_material.h"
#include "support/textured_materials.h"

namespace relief {
namespace {

Material make_brushed(float roughness, float anisotropy, float metallic) {
    Material material;
    material.base_color = {1, 1, 1};
    material.roughness = roughness, material.metallic = metallic;
    material.specular_roughness_anisotropy = anisotropy;
    return material;
}

Material add_brushed_coat(Material material) {
    material.coat_weight = 0.8f, material.coat_roughness = 0.6f;
    material.coat_roughness_anisotropy = 0.7f;
    return material;
}

/// Of one material from all azimuths.
void expect_all_light(const Material& material, double bound) {
    const Layered layered(material);
    for (const float cosine : {0.02f, 0.1f, 0.3f, 0.6f, 0.95f})
        for (const float azimuth : {0.0f, 0.2f, 0.6f, 1.0f, 1.3f, 1.5f, 1.57f, 4.0f})
            EXPECT_NEAR(layered.estimate_albedo(cosine, 1u << 13, azimuth).x, 1,
                        cosine < 0.05f ? 2 * bound : bound)
                << "roughness " << material.roughness << " anisotropy "
                << material.specular_roughness_anisotropy << " metallic " << material.metallic << " coat "
                << material.coat_weight << " cosine " << cosine << " azimuth " << azimuth;
}

TEST(Anisotropy, of_white_stacks_returns_all_light_from_every_side) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.3f, 0.6f, 1.0f})
            for (const float anisotropy : {0.3f, 0.8f}) {
                const Material white = make_brushed(roughness, anisotropy, metallic);
                expect_all_light(white, 0.01);
                expect_all_light(add_brushed_coat(white), 0.01);
            }
    for (const float metallic : {0.0f, 1.0f}) expect_all_light(make_brushed(0.7f, 1, metallic), 0.02);
}

TEST(Anisotropy, is_reciprocal_and_drawn_as_its_density_says) {
    Random random(4);
    Material both = add_brushed_coat(make_brushed(0.5f, 0.8f, 0.5f));
    both.base_color = {0.7f, 0.5f, 0.3f}, both.fuzz_weight = 0.3f;
    const HemisphereCells cells{.fine = 16};
    for (const Material& material : {make_brushed(0.5f, 0.6f, 1), both}) {
        const Layered layered(material);
        for (int n = 0; n < 400; ++n) {
            const Vec3f a = direction(0.02f + 0.95f * random.next(), 6 * random.next());
            const Vec3f b = direction(0.02f + 0.95f * random.next(), 6 * random.next());
            const Vec3f ab = layered.evaluate(a, b).value * (1 / b.z);
            const Vec3f ba = layered.evaluate(b, a).value * (1 / a.z);
            ASSERT_NEAR(ab.x, ba.x, 3e-4 * (double(ab.x) + 1e-3)) << n;
            ASSERT_NEAR(ab.z, ba.z, 3e-4 * (double(ab.z) + 1e-3)) << n;
        }
        for (const float azimuth : {0.2f, 1.2f}) {
            const Vec3f wo = direction(0.5f, azimuth);
            const scalar::LayeredBsdf bsdf = layered.make(wo);
            const auto draw = [&] {
                const float lobe = random.next();
                return layered.sample(bsdf, wo, lobe, random.next_pair()).direction;
            };
            const auto get_density = [&](const Vec3f& wi) { return layered.evaluate(wo, wi).pdf; };
            EXPECT_LT(measure_chi2(cells, draw, get_density), chi_square_limit(cells.count() - 1)) << azimuth;
        }
    }
}

TEST(Anisotropy, of_zero_has_the_bits_of_a_material_without) {
    Material coated = make_brushed(0.4f, 0, 0.3f);
    coated.coat_weight = 0.5f, coated.coat_roughness = 0.3f, coated.fuzz_weight = 0.5f;
    Material coatless = make_brushed(0.4f, 0, 0.3f);
    coatless.fuzz_weight = 0.5f;
    Material unused = coatless;
    unused.coat_roughness_anisotropy = 1; // of no coat
    const Layered plain(coatless), same(unused);
    Random random(5);
    for (int k = 0; k < 1000; ++k) {
        const Vec3f wo = direction(0.02f + 0.95f * random.next(), 6 * random.next());
        const Vec3f wi = direction(0.02f + 0.95f * random.next(), 6 * random.next());
        ASSERT_EQ(plain.evaluate(wo, wi).value, same.evaluate(wo, wi).value);
    }
    const MaterialLayers layers = make_material_layers({coated});
    EXPECT_EQ(layers.records[0].azimuth_scale, 0);
    EXPECT_EQ(layers.entries.size(), 2 * scalar::kLayerColumnCount + 1);
}

/// Of a floor that mirrors a sky with a bright spot overhead: how far the light spreads along x and z.
Vec2f measure_spread(float anisotropy, bool has_turned_uvs) {
    Material metal = make_brushed(0.45f, anisotropy, 1);
    Scene scene;
    Mesh floor = make_floor(1);
    if (has_turned_uvs) floor.uvs = {{0, 0}, {0, 1}, {-1, 1}, {-1, 0}};
    add_object(scene, floor, metal);
    scene.lights.push_back(
        {.type = LightType::point, .position = {0, 1, 0}, .radius = 0.05f, .strength = 10});
    scene.camera.from = {0, 30, 0}, scene.camera.up = {0, 0, -1};
    scene.camera.fov_degrees = 3;
    const RenderSettings settings = make_small_settings(32, 16, 0);
    const Image image = render(std::move(scene), settings).image;
    const size_t green = image.find_channel("G").value();
    double sum = 0, xx = 0, yy = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double light = double(image.at(x, y, green)), dx = x - 15.5, dy = y - 15.5;
            sum += light, xx += light * dx * dx, yy += light * dy * dy;
        }
    return {float(std::sqrt(xx / sum)), float(std::sqrt(yy / sum))};
}

TEST(Anisotropy, spreads_highlights_along_the_uvs) {
    const Vec2f round = measure_spread(0, false), along = measure_spread(0.8f, false),
                turned = measure_spread(0.8f, true);
    EXPECT_NEAR(round.x / round.y, 1, 0.03);
    EXPECT_GT(along.x, 1.5f * along.y); // the floor's u is +x
    EXPECT_GT(turned.y, 1.5f * turned.x);
    EXPECT_NEAR(turned.y / along.x, 1, 0.03);
}

double render_furnace(const Material& material) {
    Scene scene;
    add_object(scene, make_uv_sphere(), material);
    scene.environment = Environment{};
    scene.camera.from = {0.5f, 1, 4}, scene.camera.fov_degrees = 32;
    const Mean mean = compute_covered_mean(render(std::move(scene), make_small_settings(32, 64, 4)).image);
    EXPECT_LT(mean.standard_error, 0.01);
    return mean.value;
}

TEST(Anisotropy, of_textured_roughness_returns_all_light) {
    Material rough = make_brushed(0.9f, 0.7f, 0.5f);
    rough.textures = {make_input_texture(MaterialInput::roughness, {0.3f, 1, 0.6f, 0.8f})};
    EXPECT_NEAR(render_furnace(rough), 1, 0.015);
    Material coated = add_brushed_coat(make_brushed(0.9f, 0.7f, 0.5f));
    coated.textures = {make_input_texture(MaterialInput::roughness, {0.3f, 1, 0.6f, 0.8f}),
                       make_input_texture(MaterialInput::coat_weight, {0, 1})};
    EXPECT_NEAR(render_furnace(coated), 1, 0.015);
    Material colored = make_brushed(0.6f, 0.7f, 1);
    colored.textures = {make_input_texture(MaterialInput::base_color, {1, 1})};
    EXPECT_NEAR(render_furnace(colored), 1, 0.015);
}

} // namespace
} // namespace relief
