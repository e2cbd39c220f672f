#include "io/scene/scene_content.h"

#include <array>
#include <bit>
#include <set>

#include "relief/io.h"

namespace relief {

namespace {

uint64_t hash_texture(const Texture& texture) {
    ContentHash hash;
    hash.add(std::array{texture.width, texture.height, texture.channel_count});
    hash.add(texture.floats), hash.add(texture.halves);
    return hash.value();
}

} // namespace

uint64_t hash_mesh(const Mesh& mesh) {
    ContentHash hash;
    hash.add(mesh.positions), hash.add(mesh.uvs), hash.add(mesh.normals), hash.add(mesh.face_sizes);
    hash.add(mesh.position_indices), hash.add(mesh.uv_indices), hash.add(mesh.normal_indices);
    hash.add(mesh.tangents), hash.add(mesh.creases);
    for (const UvSet& set : mesh.further_uvs) {
        hash.add(std::array{uint32_t(set.number)});
        hash.add(set.uvs), hash.add(set.indices);
    }
    const Subdivision& subdivision = mesh.subdivision;
    if (subdivision.scheme != SubdivisionScheme::none)
        hash.add(std::array{uint32_t(subdivision.scheme), uint32_t(subdivision.level),
                            uint32_t(subdivision.uv), uint32_t(subdivision.boundary),
                            uint32_t(subdivision.creases)});
    if (mesh.weld) hash.add(std::array{uint32_t(1), std::bit_cast<uint32_t>(*mesh.weld)});
    return hash.value();
}

void SceneContent::set_mesh(size_t index, uint64_t hash) {
    if (index >= meshes_.size()) meshes_.resize(index + 1);
    meshes_[index] = hash;
}

void add_scene_content(ContentHash& hash, const Scene& scene) { SceneContent().add_to(hash, scene); }

uint64_t SceneContent::find_hash(const std::shared_ptr<const Texture>& texture) {
    const auto [found, is_new] = textures_.try_emplace(texture);
    if (is_new) found->second = hash_texture(*texture);
    return found->second;
}

void SceneContent::add_to(ContentHash& hash, const Scene& scene) {
    std::erase_if(textures_, [](const auto& entry) { return entry.first.expired(); });
    meshes_.resize(scene.meshes.size());
    for (size_t k = 0; k < meshes_.size(); ++k)
        if (!scene.meshes[k].face_sizes.empty()) meshes_[k] = hash_mesh(scene.meshes[k]);
    hash.add(meshes_);
    std::set<const Texture*> seen;
    const auto add_texture = [&](const std::shared_ptr<const Texture>& texture) {
        if (texture && seen.insert(texture.get()).second) hash.add(std::vector{find_hash(texture)});
    };
    for (const Displacement& displacement : scene.displacements)
        for (const MapTile& tile : displacement.tiles) {
            hash.add(std::array{uint32_t(tile.udim)});
            add_texture(tile.texture);
        }
    for (const Material& material : scene.materials)
        visit_textures(material, [&](const char*, const auto& texture, MapFilter) { add_texture(texture); });
    if (scene.environment) add_texture(scene.environment->texture);
    for (const Light& light : scene.lights) add_texture(light.color_texture);
}

} // namespace relief
