// A square of two units that a map displaces along its normal: a dome, one unit high at its middle.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "relief/scene.h"

inline relief::Scene make_displaced_plane() {
    relief::Mesh mesh;
    mesh.name = "square";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_sizes = {4};
    mesh.position_indices = {0, 1, 2, 3};
    mesh.uv_indices = {0, 1, 2, 3};

    // Four channels a texel: displacement along the tangent, the bitangent and the normal, and one that is
    // not read.
    relief::Texture texels;
    texels.width = texels.height = 65;
    texels.channel_count = 3;
    for (int y = 0; y < 65; ++y)
        for (int x = 0; x < 65; ++x) {
            const float u = (float(x) - 32) / 32, v = (float(y) - 32) / 32;
            const float height = std::cos(u * 1.5708f) * std::cos(v * 1.5708f);
            texels.floats.insert(texels.floats.end(), {0, 0, height, 1});
        }
    relief::Displacement map;
    map.name = "dome";
    map.tiles = {{1001, std::make_shared<const relief::Texture>(std::move(texels))}};

    relief::Object object;
    object.mesh = 0;
    object.displacement = 0;

    relief::Scene scene;
    scene.meshes = {std::move(mesh)};
    scene.displacements = {std::move(map)};
    scene.objects = {object};
    scene.environment = relief::Environment{};
    scene.camera = {.from = {0, -4, 3}, .to = {0, 0, 0.3f}, .up = {0, 0, 1}};
    return scene;
}
