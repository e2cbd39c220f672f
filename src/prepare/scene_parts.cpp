#include "prepare/scene_parts.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
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

/// Of parts with names, each under the number of the one before of its name; kNoIndex: there was none.
template <class Part>
std::vector<uint32_t> find_old_numbers(const std::vector<Part>& parts, const std::vector<Part>& before) {
    std::map<std::string_view, uint32_t> numbers;
    for (uint32_t k = 0; k < before.size(); ++k) numbers.try_emplace(before[k].name, k);
    std::vector<uint32_t> result(parts.size(), kNoIndex);
    for (uint32_t k = 0; k < parts.size(); ++k) {
        const auto found = numbers.find(parts[k].name);
        if (k < before.size() && before[k].name == parts[k].name)
            result[k] = k;
        else if (found != numbers.end() && !parts[k].name.empty())
            result[k] = found->second;
    }
    return result;
}

/// As std::move, but that the name stays with both.
Mesh move_mesh(Mesh& mesh) {
    Mesh empty;
    empty.name = mesh.name;
    return std::exchange(mesh, std::move(empty));
}

void put_back(Scene& scene, SceneParts* before, size_t k, uint32_t old) {
    Mesh& mesh = scene.meshes[k];
    if (old == kNoIndex || is_left_out(before->meshes[old]))
        throw Error(ErrorKind::usage,
                    {"a mesh without faces stands for the one before, and there is none",
                     mesh.name.empty() ? fmt::format("mesh {}", k) : mesh.name, "give the mesh itself"});
    mesh = move_mesh(before->meshes[old]);
}

/// The meshes that use a displacement, by their numbers before.
bool has_old_users(const std::vector<uint32_t>& users, const std::vector<uint32_t>& before,
                   const SameParts& same) {
    std::vector<uint32_t> old;
    for (const uint32_t mesh : users) {
        if (!same.meshes[mesh]) return false;
        old.push_back(same.old_meshes[mesh]);
    }
    std::ranges::sort(old);
    return old == before;
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

SurfaceKey SameParts::find_old(const SurfaceKey& key) const {
    const auto [mesh, displacement, object] = key;
    return {old_meshes[mesh], displacement == kNoIndex ? kNoIndex : old_displacements[displacement], object};
}

bool SameParts::has_old_numbers() const {
    const auto is_same = [](const std::vector<uint32_t>& old) {
        for (uint32_t k = 0; k < old.size(); ++k)
            if (old[k] != kNoIndex && old[k] != k) return false;
        return true;
    };
    return is_same(old_meshes) && is_same(old_displacements);
}

SameParts find_same_parts(Scene& scene, SceneParts* before) {
    SameParts same;
    same.meshes.resize(scene.meshes.size()), same.old_meshes.resize(scene.meshes.size(), kNoIndex);
    same.images.resize(scene.displacements.size()), same.bases.resize(scene.displacements.size());
    same.old_displacements.resize(scene.displacements.size(), kNoIndex);
    if (!before) return same;
    same.old_meshes = find_old_numbers(scene.meshes, before->meshes);
    same.old_displacements = find_old_numbers(scene.displacements, before->displacements);
    for (size_t k = 0; k < scene.meshes.size(); ++k) {
        same.meshes[k] = is_left_out(scene.meshes[k]);
        if (same.meshes[k]) put_back(scene, before, k, same.old_meshes[k]);
    }
    same.materials = scene.materials == before->materials;
    const std::vector<std::vector<uint32_t>> users = list_users(scene);
    for (size_t k = 0; k < scene.displacements.size(); ++k) {
        const uint32_t old = same.old_displacements[k];
        if (old == kNoIndex) continue;
        const Displacement &now = scene.displacements[k], &then = before->displacements[old];
        same.bases[k] = has_same_base(now, then);
        same.images[k] = has_same_images(now, then) && has_old_users(users[k], before->users[old], same);
    }
    return same;
}

void give_back(Scene& scene, SceneParts& next, SceneParts& before) {
    std::vector<Mesh>& meshes = scene.meshes.empty() ? next.meshes : scene.meshes;
    const std::vector<uint32_t> old_meshes = find_old_numbers(meshes, before.meshes);
    for (size_t k = 0; k < meshes.size(); ++k)
        if (old_meshes[k] != kNoIndex && is_left_out(before.meshes[old_meshes[k]]))
            before.meshes[old_meshes[k]] = std::move(meshes[k]);
    SameParts same;
    same.old_meshes = old_meshes;
    same.old_displacements = find_old_numbers(next.displacements, before.displacements);
    PreparedScene &made = *next.prepared.scene, &kept = *before.prepared.scene;
    for (const auto& [key, surface] : next.surfaces) {
        const auto found = before.surfaces.find(same.find_old(key));
        if (found == before.surfaces.end() || surface >= made.surfaces.size()) continue;
        Surface& place = kept.surfaces[found->second];
        if (place.patch_count() == 0) place = std::move(made.surfaces[surface]);
    }
}

} // namespace relief
