// A body with two uv sets, and materials whose textures lie on one of them.
#pragma once

#include <utility>

#include "support/textured_materials.h"

namespace relief {

inline constexpr int kFurtherSet = 2;

/// A sphere of quads, or triangles, with uvs by x and y, and further ones by z and y.
inline Mesh make_two_set_sphere(bool has_triangles = false) {
    Mesh mesh = make_uv_sphere();
    UvSet set{kFurtherSet, {}, {}};
    for (const Vec3f& p : mesh.positions) set.uvs.push_back({0.5f + 0.3f * p.z, 0.4f - 0.35f * p.y});
    if (has_triangles) {
        std::vector<uint32_t> corners;
        for (uint32_t first = 0; first < mesh.position_indices.size(); first += 4)
            for (const uint32_t k : {0, 1, 2, 0, 2, 3}) corners.push_back(mesh.position_indices[first + k]);
        mesh.face_sizes.assign(corners.size() / 3, 3);
        mesh.position_indices = mesh.uv_indices = mesh.normal_indices = corners;
    }
    set.indices = mesh.uv_indices;
    mesh.further_uvs = {set};
    return mesh;
}

/// The further uvs are the mesh's own, and the other way round.
inline Mesh exchange_sets(Mesh mesh) {
    std::swap(mesh.uvs, mesh.further_uvs.at(0).uvs);
    std::swap(mesh.uv_indices, mesh.further_uvs[0].indices);
    return mesh;
}

inline Material put_on_set(Material material, int uv_set) {
    for (InputTexture& texture : material.textures) texture.uv_set = uv_set;
    return material;
}

/// Layers, a cut-out, an emitter, a wall and a body of glass, each with textures of four values.
inline std::vector<Material> make_set_materials() {
    using enum MaterialInput;
    std::vector<Material> materials(5);
    const std::vector<float> values = {0.2f, 0.9f, 0.6f, 0.4f};
    materials[0] = make_rich_material();
    for (const MaterialInput input : {base_color, roughness, metallic, coat_weight, fuzz_color})
        materials[0].textures.push_back(make_input_texture(input, values));
    materials[1].textures = {make_input_texture(opacity, {0, 1, 0.7f, 0.2f})};
    materials[2].emission = {3, 2, 1};
    materials[2].textures = {make_input_texture(emission, {0.1f, 1, 0.5f, 0.3f})};
    for (Material* glass : {&materials[3], &materials[4]}) {
        glass->transmission_weight = 1, glass->roughness = glass == &materials[3] ? 0.0f : 0.2f;
        glass->is_thin_walled = glass == &materials[3];
        glass->textures = {make_input_texture(transmission_color, values),
                           make_input_texture(transmission_weight, values)};
    }
    for (Material& material : materials) material.textures[0].uv_scale = {1.7f, 1.3f};
    return materials;
}

/// The body on a floor, under a sun and a sky.
inline Scene make_set_scene(Mesh mesh, const Material& material) {
    Scene scene;
    add_object(scene, std::move(mesh), material);
    add_object(scene, make_floor(3), make_matte(0.5f));
    scene.objects.back().world_from_object.translation = {0, -1, 0};
    scene.environment = Environment{};
    scene.environment->color = {0.5f, 0.5f, 0.6f};
    scene.lights.push_back({.direction = {-1, -2, -1}, .strength = 2});
    scene.camera.from = {0.5f, 1, 4};
    return scene;
}

/// Two unit squares side by side in tiles 1001 and 1012, on a map of both that moves nothing.
inline Scene make_tiled_scene() {
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.face_sizes = {4, 4};
    mesh.position_indices = {0, 1, 4, 3, 1, 2, 5, 4};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}, {2, 1}, {2, 2}, {1, 2}};
    mesh.uv_indices = {0, 1, 2, 3, 4, 5, 6, 7};
    Scene scene;
    Material material = make_matte(1);
    material.textures = {{.input = MaterialInput::base_color,
                          .tiles = {{1001, make_grey_texture({0.25f})}, {1012, make_grey_texture({0.75f})}},
                          .is_udim = true}};
    add_object(scene, mesh, material);
    Displacement map;
    map.is_udim = true;
    map.tiles = {{1001, make_grey_texture({0})}, {1012, make_grey_texture({0})}};
    scene.displacements = {map};
    scene.objects[0].displacement = 0;
    scene.environment = Environment{};
    scene.camera.from = {0, 0.5f, 3}, scene.camera.to = {0, 0.5f, 0};
    return scene;
}

} // namespace relief
