// Materials whose inputs have textures, and a body to put them on.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "support/shading_scenes.h"

namespace relief {

/// One value, a row of two, or two rows of two, from the top left.
inline std::shared_ptr<const Texture> make_grey_texture(const std::vector<float>& values) {
    auto texture = std::make_shared<Texture>();
    texture->width = values.size() > 1 ? 2 : 1, texture->height = values.size() > 2 ? 2 : 1;
    texture->channel_count = 1;
    for (const float value : values) texture->floats.insert(texture->floats.end(), {value, 0, 0, 1});
    return texture;
}

inline InputTexture make_input_texture(MaterialInput input, const std::vector<float>& values) {
    return {.input = input, .tiles = {{1001, make_grey_texture(values)}}};
}

/// A sphere whose places on textures turn around it.
inline Mesh make_uv_sphere() {
    Mesh mesh = make_sphere(12, SphereNormals::smooth);
    for (const Vec3f& p : mesh.positions) mesh.uvs.push_back({0.5f + 0.45f * p.x, 0.5f + 0.45f * p.y});
    mesh.uv_indices = mesh.position_indices;
    return mesh;
}

/// Something of every layer.
inline Material make_rich_material() {
    Material material;
    material.base_color = {0.8f, 0.6f, 0.4f}, material.roughness = 0.6f, material.metallic = 0.4f;
    material.base_diffuse_roughness = 0.8f;
    material.specular_weight = 0.9f, material.specular_color = {1, 0.9f, 0.7f};
    material.coat_weight = 0.8f, material.coat_color = {0.9f, 0.6f, 0.5f}, material.coat_roughness = 0.4f;
    material.fuzz_weight = 0.7f, material.fuzz_color = {0.9f, 0.8f, 1}, material.fuzz_roughness = 0.8f;
    return material;
}

} // namespace relief
