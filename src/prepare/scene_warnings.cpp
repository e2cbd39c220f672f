#include "prepare/scene_warnings.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "relief/inspect.h"
#include "scene/face_uvs.h"
#include "scene/texture_tiles.h"
#include "scene/tile_use.h"
#include "scene/uv_sets.h"
#include "surface/mesh/degenerate_faces.h"
#include "surface/mesh/join_points.h"

namespace relief {

namespace {

/// Below this level quads beside semi-sharp creases come too close to each other to be cut along them.
constexpr int kLevelForCreases = 2;

/// Semi-sharp creases that are wider than nothing at the level of their mesh are fitted there, not exact.
void warn_of_creases(const Mesh& mesh, std::vector<std::string>& warnings) {
    const Subdivision& subdivision = mesh.subdivision;
    if (subdivision.scheme != SubdivisionScheme::catmark || subdivision.creases != CreaseRule::obey ||
        subdivision.level == kAutoSubdivisionLevel)
        return;
    float sharpest = 0;
    for (const Crease& crease : mesh.creases)
        if (crease.sharpness < kInfiniteSharpness) sharpest = std::max(sharpest, crease.sharpness);
    const int level = std::min(kLevelForCreases, int(std::ceil(sharpest)));
    if (level <= subdivision.level) return;
    warnings.push_back(
        fmt::format("mesh '{}': creases of sharpness {:g} are narrower than the patches of subdivision level "
                    "{} and fitted by them; level {} shows them as they are",
                    mesh.name, sharpest, subdivision.level, level));
}

void warn_of_degenerate_faces(const Mesh& mesh, std::vector<std::string>& warnings) {
    const DegenerateFaces faces = find_degenerate_faces(mesh);
    if (faces.count == 0 || faces.count == mesh.face_sizes.size()) return;
    warnings.push_back(
        fmt::format("mesh '{}': {} of {} faces have no area and are left out; the first is face {}",
                    mesh.name, faces.count, mesh.face_sizes.size(), faces.first));
}

/// The mesh is displaced or subdivided. Other meshes look as their files have them.
void warn_of_near_edges(const Mesh& mesh, std::vector<std::string>& warnings) {
    const NearEdges edges = find_near_edges(mesh);
    if (edges.count == 0) return;
    warnings.push_back(fmt::format("mesh '{}': {}", mesh.name, describe_near_edges(edges)));
}

bool has_texture(const Material& material) {
    bool has_one = false;
    visit_textures(material, [&](const char*, const auto& texture, MapFilter) { has_one |= !!texture; });
    return has_one;
}

/// The mesh is displaced, or its material reads a texture.
void warn_of_faces_without_uvs(const Mesh& mesh, std::vector<std::string>& warnings) {
    const FacesWithoutUvs faces = find_faces_without_uvs(mesh);
    if (faces.count == 0) return;
    warnings.push_back(fmt::format(
        "mesh '{}': {} of {} faces have no uvs: they are not displaced, and textures are read at (0, 0) "
        "there; the first is face {}",
        mesh.name, faces.count, mesh.face_sizes.size(), faces.first));
}

/// Textures of the material use this further set.
void warn_of_faces_without_set(const Mesh& mesh, const UvSet& set, std::vector<std::string>& warnings) {
    const FacesWithoutUvs faces = find_faces_without_uvs(mesh.face_sizes, set.indices);
    if (faces.count == 0) return;
    warnings.push_back(
        fmt::format("mesh '{}': {} of {} faces have no uvs in set {}: textures on it are read at "
                    "(0, 0) there; the first is face {}",
                    mesh.name, faces.count, mesh.face_sizes.size(), set.number, faces.first));
}

bool is_black(const Vec3f& color) { return color.x == 0 && color.y == 0 && color.z == 0; }

void warn_of_darkness(const Scene& scene, std::vector<std::string>& warnings) {
    if (scene.objects.empty()) {
        warnings.emplace_back(
            "the scene has no objects; only its environment and lights that the camera sees are there");
        return;
    }
    const bool has_light =
        (scene.environment && scene.environment->strength > 0 && !is_black(scene.environment->color)) ||
        std::any_of(scene.lights.begin(), scene.lights.end(),
                    [](const Light& light) { return light.strength > 0 && !is_black(light.color); }) ||
        std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
            return object.material != kNoIndex && !is_black(scene.materials[object.material].emission);
        });
    if (!has_light)
        warnings.emplace_back(
            "nothing in the scene gives light, and the picture is black; add an environment, a "
            "light or an emission");
}

} // namespace

std::vector<std::string> find_edge_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    std::set<uint32_t> seen;
    for (const Object& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool is_joined =
            object.displacement != kNoIndex || mesh.subdivision.scheme != SubdivisionScheme::none;
        if (is_joined && seen.insert(object.mesh).second) warn_of_near_edges(mesh, warnings);
    }
    return warnings;
}

std::vector<std::string> find_scene_warnings(const Scene& scene, const ImageSettings& image) {
    std::vector<std::string> warnings;
    if (image.noise > 0 && image.spp <= ImageSettings::kLeastNoiseSamples)
        warnings.push_back(fmt::format("image.noise is judged after {} samples, and pixels get {} at most",
                                       ImageSettings::kLeastNoiseSamples, image.spp));
    warn_of_darkness(scene, warnings);
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    std::set<uint32_t> meshes, read_meshes;
    std::set<std::pair<uint32_t, int>> read_sets;
    std::vector<std::vector<int>> uv_sets; // of materials
    for (const Material& material : scene.materials) uv_sets.push_back(list_uv_sets(material));
    std::set<uint32_t> used;
    for (const Object& object : scene.objects)
        if (used.insert(object.mesh).second) warn_of_degenerate_faces(scene.meshes[object.mesh], warnings);
    for (const Object& object : scene.objects) {
        const bool reads_uvs = object.displacement != kNoIndex ||
                               (object.material != kNoIndex && has_texture(scene.materials[object.material]));
        if (reads_uvs && read_meshes.insert(object.mesh).second)
            warn_of_faces_without_uvs(scene.meshes[object.mesh], warnings);
        if (object.material != kNoIndex)
            for (const UvSet& set : scene.meshes[object.mesh].further_uvs)
                if (std::ranges::find(uv_sets[object.material], set.number) !=
                        uv_sets[object.material].end() &&
                    read_sets.insert({object.mesh, set.number}).second)
                    warn_of_faces_without_set(scene.meshes[object.mesh], set, warnings);
        if (object.displacement == kNoIndex) continue;
        const Mesh& mesh = scene.meshes[object.mesh];
        if (pairs.insert({object.mesh, object.displacement}).second)
            for (std::string& warning : find_tile_warnings(mesh, scene.displacements[object.displacement]))
                warnings.push_back(std::move(warning));
        if (meshes.insert(object.mesh).second) warn_of_creases(mesh, warnings);
    }
    for (std::string& warning : find_texture_tile_warnings(scene)) warnings.push_back(std::move(warning));
    return warnings;
}

} // namespace relief
