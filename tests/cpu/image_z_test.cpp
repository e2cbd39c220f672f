// A small scene with every kind of light and surface against stored means.
#include <gtest/gtest.h>

#include "support/shading_scenes.h"
#include "support/z_test.h"

namespace relief {
namespace {

constexpr int kBlocks = 4;

Material make_material(const Vec3f& color, float roughness, float metallic) {
    Material material;
    material.base_color = color;
    material.roughness = roughness;
    material.metallic = metallic;
    return material;
}

Mesh place(Mesh mesh, const Vec3f& center, float radius) {
    for (Vec3f& p : mesh.positions) p = p * radius + center;
    return mesh;
}

/// Three balls on a floor under a small panel, a sun, a point light and a sky that is brighter at one side.
Scene make_still_life() {
    Scene scene;
    add_object(scene, make_floor(6), make_material({0.7f, 0.6f, 0.5f}, 0.7f, 0));
    const Mesh sphere = make_sphere(10, SphereNormals::smooth);
    add_object(scene, place(sphere, {-1.1f, 0.6f, 0}, 0.6f), make_material({0.9f, 0.2f, 0.15f}, 0.3f, 0));
    add_object(scene, place(sphere, {0.2f, 0.6f, -0.6f}, 0.6f), make_material({0.95f, 0.8f, 0.5f}, 0.25f, 1));
    add_object(scene, place(sphere, {1.2f, 0.5f, 0.4f}, 0.5f), make_material({0.3f, 0.5f, 0.9f}, 0.6f, 0.5f));
    Material glow = make_matte(0);
    glow.emission = {6, 5, 4};
    add_object(scene, make_quad_mesh({Vec3f{-1, 2.4f, -1}, {0, 2.4f, -1}, {0, 2.4f, 0}, {-1, 2.4f, 0}}),
               glow);
    Light sun;
    sun.direction = {1, -1.5f, -0.6f};
    sun.angle_degrees = 4;
    sun.strength = 1.5f;
    Light point;
    point.type = LightType::point;
    point.position = {1.5f, 1.8f, 1.2f};
    point.radius = 0.2f;
    point.strength = 2;
    scene.lights = {sun, point};
    auto sky = std::make_shared<Texture>();
    sky->width = 32, sky->height = 16, sky->channel_count = 3;
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 32; ++x) {
            const float side = 0.5f + 0.5f * std::cos(float(x) / 32 * 2 * std::numbers::pi_v<float>);
            const float level = y < 8 ? 0.2f + 0.8f * side : 0.1f;
            sky->floats.insert(sky->floats.end(), {level * 0.7f, level * 0.8f, level, 1.0f});
        }
    scene.environment = Environment{};
    scene.environment->texture = sky;
    scene.environment->strength = 0.6f;
    scene.camera.from = {0.3f, 2.2f, 5};
    scene.camera.to = {0, 0.6f, 0};
    scene.camera.fov_degrees = 38;
    scene.camera.aperture_radius = 0.03f;
    scene.camera.focus_distance = 5;
    return scene;
}

Image render_still_life(int spp, uint32_t seed, int first_sample = 0) {
    RenderSettings settings = make_small_settings(32, spp, 4);
    settings.image.seed = seed;
    settings.image.first_sample = first_sample;
    return render(make_still_life(), settings).image;
}

// 16384 samples a pixel, seed 1.
const BlockMean kExpected[kBlocks * kBlocks] = {
    {0.0659312, 3.19e-12}, {0.0633218, 2.41e-12}, {0.0621273, 1.99e-12}, {0.0623682, 1.92e-12},
    {0.271394, 3.24e-08},  {0.25055, 1.26e-07},   {0.422774, 2.32e-06},  {0.315089, 3.52e-08},
    {0.32721, 6.89e-08},   {0.356576, 3.49e-07},  {0.386376, 3.93e-07},  {0.376242, 7.82e-08},
    {0.487997, 6.32e-08},  {0.522064, 8.43e-08},  {0.546557, 9.26e-08},  {0.546403, 7.08e-08},
};

TEST(ImageZTest, still_life_agrees_with_its_stored_means) {
    const std::vector<BlockMean> found = compute_block_means(render_still_life(64, 7), kBlocks);
    // 16 blocks: chance of a false alarm 1e-4 at 4.5 standard errors.
    EXPECT_LT(compute_largest_z(found, kExpected), 4.5) << print_block_means(found);
}

TEST(ImageZTest, tells_a_picture_that_is_two_percent_too_bright) {
    std::vector<BlockMean> found = compute_block_means(render_still_life(256, 7), kBlocks);
    for (BlockMean& block : found) block.mean *= 1.02;
    EXPECT_GT(compute_largest_z(found, kExpected), 4.5);
}

TEST(ImageZTest, gives_the_same_bits_for_any_thread_count) {
    RenderSettings settings = make_small_settings(32, 4, 3);
    settings.device.threads = 1;
    const Image one = render(make_still_life(), settings).image;
    settings.device.threads = 3;
    EXPECT_EQ(render(make_still_life(), settings).image.pixels, one.pixels);
}

TEST(ImageZTest, gives_the_same_pixels_in_a_crop) {
    RenderSettings settings = make_small_settings(32, 4, 3);
    const Image whole = render(make_still_life(), settings).image;
    settings.image.crop = {5, 9, 23, 30};
    const Image part = render(make_still_life(), settings).image;
    ASSERT_EQ(part.width, 18);
    for (int y = 9; y < 30; ++y)
        for (int x = 5; x < 23; ++x)
            for (size_t c = 0; c < whole.channels.size(); ++c) ASSERT_EQ(part.at(x, y, c), whole.at(x, y, c));
}

TEST(ImageZTest, averages_sample_ranges_to_the_whole) {
    const Image whole = render_still_life(8, 3), a = render_still_life(3, 3), b = render_still_life(5, 3, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const double joined = (3.0 * a.at(x, y, c) + 5.0 * b.at(x, y, c)) / 8;
                ASSERT_NEAR(joined, whole.at(x, y, c), 3e-7 * joined + 1e-9);
            }
}

} // namespace
} // namespace relief
