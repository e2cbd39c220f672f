// Maps of more tiles than a byte counts: a device shows what the CPU engine shows.
#include <cmath>

#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief::vulkan::tests {
namespace {

/// A sphere whose 384 faces have a tile each, which moves them to a height of their own.
Scene make_tiled_sphere() {
    Mesh mesh = test::make_cube_sphere(8);
    mesh.uvs.clear(), mesh.uv_indices.clear();
    auto make_tile = [](float height) {
        auto map = std::make_shared<Texture>();
        map->width = map->height = 1, map->channel_count = 3, map->source_type = SampleType::float32;
        map->floats = {0, 0, height, 1};
        return map;
    };
    Displacement displacement = test::make_displacement(make_tile(0), DisplacementSpace::object);
    displacement.is_udim = true;
    displacement.tiles.clear();
    for (int face = 0; face < int(mesh.face_sizes.size()); ++face) {
        for (const Vec2f& corner : {Vec2f{0.1f, 0.1f}, {0.9f, 0.1f}, {0.9f, 0.9f}, {0.1f, 0.9f}}) {
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
            mesh.uvs.push_back({corner.x + float(face % 10), corner.y + float(face / 10)});
        }
        // Every 7th tile is missing.
        if (face % 7 != 3)
            displacement.tiles.push_back({1001 + face, make_tile(0.1f * std::sin(0.7f * float(face)))});
    }
    Scene scene = test::make_body_scene(std::move(mesh), std::move(displacement));
    scene.camera.from = {0.5f, 1, 4}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 40;
    return scene;
}

TEST(DeviceTiles, hundreds_of_tiles_are_read_as_on_the_cpu_engine) {
    RenderSettings settings = make_small_settings(64, 1, 0);
    settings.surface.level = 2;
    settings.image.layers = {"depth"};
    const Image same = render(make_tiled_sphere(), settings).image;
    settings.device.engine = EngineKind::vulkan;
    settings.device.index = get_test_device_index();
    const Image image = render(make_tiled_sphere(), settings).image;
    const size_t depth = image.find_channel("depth.Z").value();
    size_t met = 0, other = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const float a = image.at(x, y, depth), b = same.at(x, y, depth);
            met += std::isfinite(b);
            other += std::isfinite(a) != std::isfinite(b) || (std::isfinite(b) && std::fabs(a - b) > 1e-4f);
        }
    EXPECT_GT(met, 1000u);
    EXPECT_LE(other, 2u); // rays at an edge may hit on one engine only
}

} // namespace
} // namespace relief::vulkan::tests
