// No ray passes between faces whose points nearly coincide.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "relief/render.h"

namespace relief {
namespace {

/// A displaced cube from inside, its six faces with corners of their own, which are up to 1e-6 apart.
Scene make_loose_room(std::optional<float> weld) {
    constexpr std::array<std::array<int, 4>, 6> kFaces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    std::mt19937 random(5);
    const auto move = [&](int bit) { return (bit ? 1.0f : -1.0f) + 1e-9f * float(random() % 1000); };
    Mesh mesh;
    mesh.name = "room";
    mesh.weld = weld;
    for (size_t face = 0; face < kFaces.size(); ++face) {
        mesh.face_sizes.push_back(4);
        for (size_t k = 0; k < 4; ++k) {
            const int corner = kFaces[face][k];
            const float x = move(corner & 1), y = move(corner & 2), z = move(corner & 4);
            mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
            mesh.positions.push_back({x, y, z});
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
            mesh.uvs.push_back({(float(face % 3) + (k == 1 || k == 2 ? 0.95f : 0.05f)) / 3,
                                (float(face / 3) + (k > 1 ? 0.95f : 0.05f)) / 2});
        }
    }
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 64, texture->channel_count = 3;
    texture->file = "noise.exr";
    for (size_t k = 0; k < size_t(4) * 64 * 64; ++k)
        texture->floats.push_back(float(random() % 2001) / 1000 * 0.1f - 0.1f);
    Displacement map;
    map.name = "noise";
    map.tiles.push_back({1001, texture});
    Scene scene;
    scene.meshes.push_back(mesh), scene.displacements.push_back(map);
    scene.objects.emplace_back();
    scene.objects[0].displacement = 0;
    scene.environment = Environment{};
    scene.camera.from = {0.1f, -0.05f, 0}, scene.camera.to = {1, 1, 1}, scene.camera.fov_degrees = 120;
    return scene;
}

size_t count_open_pixels(std::optional<float> weld) {
    RenderSettings settings;
    settings.image.width = settings.image.height = 96, settings.image.spp = 1, settings.image.bounces = 0;
    settings.image.background = Vec3f{};
    const Image image = render(make_loose_room(weld), settings).image;
    size_t open = 0;
    for (uint32_t y = 0; y < 96; ++y)
        for (uint32_t x = 0; x < 96; ++x) open += image.at(x, y, *image.find_channel("A")) < 1 ? 1 : 0;
    return open;
}

TEST(JoinedPoints, close_a_room_whose_walls_have_points_of_their_own) {
    EXPECT_EQ(count_open_pixels(std::nullopt), 0u);
    EXPECT_GT(count_open_pixels(0.0f), 20u);
}

} // namespace
} // namespace relief
