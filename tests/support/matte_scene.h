// A wall of small squares with names, more of them in a pixel than a picture has ranks for.
#pragma once

#include <array>
#include <string>

#include "relief/render.h"
#include "support/shading_scenes.h"

namespace relief::test {

inline constexpr std::array<const char*, 3> kWallMaterials = {"chalk", "slate", "brick"};

/// Squares of a spacing before a camera that sees one unit of the wall a pixel, 6 x 4 of them.
inline Scene make_wall(float spacing) {
    Scene scene;
    const float half = 0.4f * spacing;
    scene.meshes.push_back(
        make_quad_mesh({Vec3f{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}));
    for (const char* name : kWallMaterials) scene.materials.emplace_back().name = name;
    const int columns = int(2.5f / spacing), rows = int(1.5f / spacing);
    for (int j = -rows; j <= rows; ++j)
        for (int i = -columns; i <= columns; ++i) {
            Object& object = scene.objects.emplace_back();
            object.name = "square " + std::to_string(i) + " " + std::to_string(j);
            object.material = uint32_t(scene.objects.size() % 3);
            object.world_from_object.translation = {float(i) * spacing, float(j) * spacing, 0};
        }
    scene.camera.from = {0, 0, 10}, scene.camera.to = {0, 0, 0};
    scene.camera.fov_degrees = 2 * 11.309932f; // 2 / 10 is its tangent
    scene.environment = Environment{};
    return scene;
}

inline RenderSettings make_wall_settings(int spp) {
    RenderSettings settings;
    settings.image.width = 6, settings.image.height = 4;
    settings.image.spp = spp, settings.image.bounces = 0;
    settings.image.layers = {"samples", "CryptoObject", "CryptoMaterial"};
    return settings;
}

} // namespace relief::test
