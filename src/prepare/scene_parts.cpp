#include "prepare/scene_parts.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

/// Whether the tiles are those of another map, of the same sizes.
bool has_same_tiles(const Displacement& a, const Displacement& b) {
    return std::ranges::equal(a.tiles, b.tiles, [](const MapTile& x, const MapTile& y) {
        return x.udim == y.udim && x.texture && y.texture && x.texture->width == y.texture->width &&
               x.texture->height == y.texture->height;
    });
}

bool has_same_images(const Displacement& a, const Displacement& b) {
    return a.flip_v == b.flip_v && a.is_udim == b.is_udim && a.wrap == b.wrap && a.dilate == b.dilate &&
           a.filter == b.filter && a.dequantize == b.dequantize && a.name == b.name &&
           std::ranges::equal(a.tiles, b.tiles, [](const MapTile& x, const MapTile& y) {
               return x.udim == y.udim && x.texture == y.texture;
           });
}

bool has_same_base(const Displacement& a, const Displacement& b) {
    return a.type == b.type && a.space == b.space && a.frame == b.frame && a.lengths == b.lengths &&
           a.is_udim == b.is_udim && has_same_tiles(a, b);
}

void put_back(Scene& scene, SceneParts* before, size_t k) {
    Mesh& mesh = scene.meshes[k];
    if (!before || k >= before->meshes.size() || before->meshes[k].name != mesh.name ||
        is_left_out(before->meshes[k]))
        throw Error(ErrorKind::usage,
                    {"a mesh without faces stands for the one before, and there is none",
                     mesh.name.empty() ? fmt::format("mesh {}", k) : mesh.name, "give the mesh itself"});
    mesh = std::move(before->meshes[k]);
}

} // namespace

std::vector<std::vector<uint32_t>> list_users(const Scene& scene) {
    std::vector<std::set<uint32_t>> meshes(scene.displacements.size());
    for (const Object& object : scene.objects)
        if (object.displacement != kNoIndex) meshes[object.displacement].insert(object.mesh);
    std::vector<std::vector<uint32_t>> users;
    for (const std::set<uint32_t>& list : meshes) users.emplace_back(list.begin(), list.end());
    return users;
}

SameParts find_same_parts(Scene& scene, SceneParts* before) {
    SameParts same;
    for (size_t k = 0; k < scene.meshes.size(); ++k) {
        same.meshes.push_back(before && is_left_out(scene.meshes[k]));
        if (same.meshes.back()) put_back(scene, before, k);
    }
    same.images.resize(scene.displacements.size());
    same.bases.resize(scene.displacements.size());
    if (!before) return same;
    same.materials = scene.materials == before->materials;
    const std::vector<std::vector<uint32_t>> users = list_users(scene);
    for (size_t k = 0; k < std::min(scene.displacements.size(), before->displacements.size()); ++k) {
        const Displacement &now = scene.displacements[k], &then = before->displacements[k];
        const auto is_same = [&](uint32_t mesh) { return same.meshes[mesh] != 0; };
        same.bases[k] = has_same_base(now, then);
        same.images[k] = has_same_images(now, then) && users[k] == before->users[k] &&
                         std::ranges::all_of(users[k], is_same);
    }
    // The lists of images and maps go by the numbers of displacements and tiles.
    if (scene.displacements.size() != before->displacements.size())
        std::ranges::fill(same.images, uint8_t(0)), std::ranges::fill(same.bases, uint8_t(0));
    return same;
}

} // namespace relief
