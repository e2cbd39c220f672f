#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "base/machine.h"
#include "base/parallel.h"
#include "formulas/mips.h"
#include "prepare/camera_enclosure.h"
#include "prepare/local_origins.h"
#include "prepare/scene_levels.h"
#include "prepare/scene_maps.h"
#include "prepare/scene_parts.h"
#include "prepare/scene_surfaces.h"
#include "prepare/scene_warnings.h"
#include "prepare/space_warnings.h"
#include "prepare/tessellate.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"
#include "surface/mesh/corner_tangents.h"
#include "surface/patch/patch_mips.h"

namespace relief {

namespace {

/// So that pictures need not look at masks.
void check_visibility(const Scene& scene) {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (scene.objects[k].visibility_mask == 0)
            throw Error(ErrorKind::bad_input, {"its visibility mask is 0, so that no ray can meet it",
                                               scene.objects[k].name.empty() ? "object " + std::to_string(k)
                                                                             : scene.objects[k].name,
                                               "leave the object out, or set a bit"});
}

/// Normals at vertices cannot hold what is finer than the cells between them.
void drop_detail(PreparedScene& scene) {
    for (Surface& surface : scene.surfaces)
        for (uint32_t& word : surface.mips) word &= (1u << scalar::kDetailShift) - 1;
}

/// Whether a displaced surface has flat patches whose corners have different normals.
bool has_bent_base(const Surface& surface) {
    if (!surface.has_displacement || !surface.controls.empty() || surface.frames.empty()) return false;
    for (const Quad quad : surface.quads)
        for (const uint32_t vertex : quad.vertex)
            if (surface.frames[vertex].normal != surface.frames[quad.vertex[0]].normal) return true;
    return false;
}

/// Whether the cells of a displaced surface stay large from nearby: levels end at the texels of the map.
bool has_few_texels(const Surface& surface) {
    constexpr uint64_t kFewTexels = 64; // per patch
    uint64_t texels = 0;
    for (const DisplacementMap::Tile& tile : surface.map.tiles)
        texels += uint64_t(tile.texture->width) * tile.texture->height;
    return texels < kFewTexels * surface.patch_count();
}

/// Looks at surfaces before they are tessellated. The result is the same for all views, so that sessions need
/// not compute it again.
Terminators find_terminators(const PreparedScene& scene) {
    const auto has = [&](bool has_displacement) {
        return std::ranges::any_of(scene.surfaces, [&](const Surface& surface) {
            return surface.has_displacement == has_displacement && !surface.frames.empty();
        });
    };
    if (scene.levels.fixed_level >= 0 && has(true)) return Terminators::all;
    Terminators most = has(false) ? Terminators::polygons : Terminators::none;
    for (const Surface& surface : scene.surfaces) {
        if (!has_bent_base(surface)) continue;
        if (has_few_texels(surface)) return Terminators::all;
        most = Terminators::bases;
    }
    return most;
}

void prepare_materials(std::vector<Material> materials, PreparedScene& prepared) {
    prepared.materials = std::move(materials);
    prepare_textures(prepared.materials);
    prepared.materials.emplace_back();
    for (Material& material : prepared.materials)
        material.base_color = material.base_color * std::exchange(material.base_weight, 1.0f);
    prepared.has_cut_outs = std::ranges::any_of(
        prepared.materials, [](const Material& m) { return is_cut_out(m) || is_clear_wall(m); });
    prepared.has_normal_maps = std::ranges::any_of(prepared.materials, has_normal_map);
    prepared.has_anisotropy = std::ranges::any_of(prepared.materials, is_anisotropic);
    prepared.textured = make_textured_materials(prepared.materials);
    prepared.layers = make_material_layers(prepared.materials, prepared.textured);
    prepared.glass = make_material_glass(prepared.materials);
}

/// The same of equal ones.
void take_over_materials(PreparedScene& before, PreparedScene& prepared) {
    prepared.materials = std::move(before.materials);
    prepared.has_cut_outs = before.has_cut_outs, prepared.has_normal_maps = before.has_normal_maps;
    prepared.has_anisotropy = before.has_anisotropy;
    prepared.textured = std::move(before.textured), prepared.layers = std::move(before.layers);
    prepared.glass = std::move(before.glass);
}

void prepare_lights(Scene& scene, const std::vector<std::string>& layers, PreparedScene& prepared) {
    prepared.links = make_light_links(scene);
    prepared.lights = std::move(scene.lights);
    prepared.environment = std::move(scene.environment);
    prepared.light_groups = make_light_groups(
        {prepared.materials, prepared.lights, prepared.environment ? &*prepared.environment : nullptr},
        layers);
}

/// Keeps the displacements without their images, of which an editor makes its own.
void keep_conventions(const Scene& scene, SceneParts& parts) {
    parts.displacements = scene.displacements;
    for (Displacement& displacement : parts.displacements)
        for (MapTile& tile : displacement.tiles) tile.texture = nullptr;
}

/// Everything of a scene that is not tessellated. `before` may be null, `polygons` is then what becomes of
/// those of the scene.
std::vector<SurfaceChange> prepare_parts(Scene& scene, const RenderSettings& settings, SceneOrigin origin,
                                         SceneParts* before, Polygonal polygons, SceneParts& parts) {
    PreparedScene& prepared = *parts.prepared.scene;
    const SameParts same = find_same_parts(scene, before);
    validate_scene(scene);
    check_visibility(scene);
    prepared.warnings = std::move(scene.warnings);
    // Before anything else is moved out of the scene.
    for (std::string& warning : find_scene_warnings(scene, settings.image))
        prepared.warnings.push_back(std::move(warning));
    if (polygons == Polygonal::keep) {
        parts.materials = scene.materials, parts.displacements = scene.displacements;
        parts.users = list_users(scene);
    }
    prepared.levels = make_level_config(scene.camera, settings);
    if (same.materials)
        take_over_materials(*before->prepared.scene, prepared);
    else
        prepare_materials(std::move(scene.materials), prepared);
    prepare_lights(scene, settings.image.layers, prepared);
    prepared.camera = scene.camera;
    prepared.mesh_count = uint32_t(scene.meshes.size());
    prepared.width = settings.image.width, prepared.height = settings.image.height;

    const SurfaceList list = list_surfaces(scene, prepared.materials, prepared.instances);
    prepared.has_shadow_catchers = has_shadow_catchers(scene);
    parts.taken_off = move_meshes_to_origin(scene, same.meshes);
    for (size_t k = 0; k < same.meshes.size(); ++k)
        if (same.meshes[k]) parts.taken_off[k] = before->taken_off[same.old_meshes[k]];
    parts.surfaces = list.numbers, parts.has_old_numbers = same.has_old_numbers();
    MeshLimits limits(scene.meshes);
    std::vector<std::string> edge_warnings;
    parallel_invoke([&] { prepare_maps(scene, same, before, limits, parts.prepared); },
                    [&] { edge_warnings = find_edge_warnings(scene); });
    std::ranges::move(edge_warnings, std::back_inserter(prepared.warnings));
    limits.release_outlines();
    std::vector<SurfaceChange> changes = make_surfaces(scene, list, same, before, polygons, limits, parts);
    if (polygons == Polygonal::keep_for_views) keep_conventions(scene, parts);
    parts.made_surfaces = (before ? before->made_surfaces : 0) +
                          uint64_t(std::ranges::count_if(changes, &SurfaceChange::is_replaced));
    share_mips(scene, list.numbers, prepared);
    add_tangents(prepared);
    if (before) prepared.origin = before->prepared.scene->origin;
    place_instances(scene, parts.taken_off, before ? SceneOrigin::given : origin, prepared);
    if (polygons != Polygonal::free) parts.meshes = std::move(scene.meshes);
    return changes;
}

/// Of instances that are where they were, of surfaces that are as they were.
void take_over_lines(std::span<const Instance> before, std::span<const SurfaceChange> changes,
                     PreparedScene& prepared) {
    for (size_t k = 0; k < std::min(before.size(), prepared.instances.size()); ++k) {
        Instance& instance = prepared.instances[k];
        const SurfaceChange& change = changes[instance.surface];
        if (!change.is_replaced && change.is_changed.empty() && instance.surface == before[k].surface &&
            instance.world_from_object == before[k].world_from_object)
            instance.lines = before[k].lines;
    }
}

/// Levels, and what follows from them.
void finish_levels(const RenderSettings& settings, PreparedScene& prepared, ViewsToCome views) {
    update_scene_levels(prepared, settings, views);
    for (uint32_t surface = 0; surface < prepared.surfaces.size(); ++surface)
        prepared.surfaces[surface].mips = choose_scene_mips(prepared, surface);
    prepared.may_enclose_camera = may_enclose_camera(prepared);
    prepared.terminators = find_terminators(prepared);
}

/// Patches whose displacement has not changed, but the copy of the map that they read.
void mark_other_mips(std::span<const std::vector<uint32_t>> before, const PreparedScene& prepared,
                     std::vector<SurfaceChange>& changes) {
    for (SurfaceChange& change : changes) {
        const std::vector<uint32_t>& now = prepared.surfaces[change.surface].mips;
        const std::vector<uint32_t>& then = before[change.surface];
        if (change.is_replaced || now == then) continue;
        change.is_changed.resize(prepared.surfaces[change.surface].patch_count());
        for (size_t patch = 0; patch < change.is_changed.size(); ++patch)
            change.is_changed[patch] |= then.size() != now.size() || then[patch] != now[patch];
    }
}

void add_space_warnings(PreparedScene& prepared) {
    for (std::string& warning : find_space_warnings(prepared))
        prepared.warnings.push_back(std::move(warning));
}

} // namespace

void add_tangents(PreparedScene& prepared) {
    std::set<uint32_t> mapped;
    for (const Instance& instance : prepared.instances)
        if (const Material& material = prepared.materials[instance.material];
            has_normal_map(material) || is_anisotropic(material))
            mapped.insert(instance.surface);
    const std::vector<uint32_t> list(mapped.begin(), mapped.end());
    parallel_for("tangents", list.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            Surface& surface = prepared.surfaces[list[k]];
            surface.corner_tangents = make_corner_tangents(surface);
        }
    });
}

std::vector<uint32_t> choose_scene_mips(const PreparedScene& scene, uint32_t surface) {
    std::vector<const LevelField*> levels;
    for (const Instance& instance : scene.instances)
        if (instance.surface == surface) levels.push_back(instance.levels.get());
    return choose_mips(scene.surfaces[surface], levels);
}

SceneParts prepare_scene_parts(Scene scene, const RenderSettings& settings, SceneOrigin origin,
                               Polygonal polygons) {
    SceneParts parts;
    parts.prepared.scene = std::make_shared<PreparedScene>();
    PreparedScene& prepared = *parts.prepared.scene;
    prepare_parts(scene, settings, origin, nullptr, polygons, parts);
    finish_levels(settings, prepared, polygons == Polygonal::keep ? ViewsToCome::many : ViewsToCome::none);
    if (settings.surface.mode == SurfaceMode::tessellated) drop_detail(prepared);
    if (settings.surface.mode == SurfaceMode::tessellated)
        tessellate_scene(prepared, available_memory_bytes());
    add_space_warnings(prepared);
    return parts;
}

namespace {

/// As prepare_next_scene(); after an error parts of `before` may be in `scene` and `next`.
std::optional<std::vector<SurfaceChange>> prepare_beside(Scene& scene, const RenderSettings& settings,
                                                         SceneParts& before, SceneParts& next) {
    const size_t surface_count = before.prepared.scene->surfaces.size();
    std::vector<std::vector<uint32_t>> mips;
    for (Surface& surface : before.prepared.scene->surfaces) mips.push_back(surface.mips);
    std::vector<SurfaceChange> changes =
        prepare_parts(scene, settings, SceneOrigin::given, &before, Polygonal::keep, next);
    PreparedScene& prepared = *next.prepared.scene;
    const bool has_same_surfaces =
        next.has_old_numbers && next.surfaces == before.surfaces && prepared.surfaces.size() == surface_count;
    if (has_same_surfaces) take_over_lines(before.prepared.scene->instances, changes, prepared);
    finish_levels(settings, prepared, ViewsToCome::many);
    if (has_same_surfaces) mark_other_mips(mips, prepared, changes);
    add_space_warnings(prepared);
    if (!has_same_surfaces) return std::nullopt;
    std::erase_if(changes, [](const SurfaceChange& change) {
        return !change.is_replaced && std::ranges::find(change.is_changed, 1) == change.is_changed.end();
    });
    for (SurfaceChange& change : changes) change.looks_different = change.is_changed;
    return changes;
}

} // namespace

std::optional<std::vector<SurfaceChange>> prepare_next_scene(Scene scene, const RenderSettings& settings,
                                                             SceneParts& parts) {
    SceneParts next;
    next.prepared.scene = std::make_shared<PreparedScene>();
    std::optional<std::vector<SurfaceChange>> changes;
    try {
        changes = prepare_beside(scene, settings, parts, next);
    } catch (...) {
        give_back(scene, next, parts);
        PreparedScene &made = *next.prepared.scene, &kept = *parts.prepared.scene;
        if (kept.materials.empty()) take_over_materials(made, kept);
        throw;
    }
    // In place, since engines refer to it.
    std::shared_ptr<PreparedScene> place = std::move(parts.prepared.scene);
    *place = std::move(*next.prepared.scene);
    next.prepared.scene = std::move(place);
    parts = std::move(next);
    return changes;
}

std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const RenderSettings& settings,
                                                   SceneOrigin origin) {
    const std::shared_ptr<PreparedScene> prepared =
        prepare_scene_parts(std::move(scene), settings, origin, Polygonal::free).prepared.scene;
    for (PreparedMap& map : prepared->maps)
        if (map.coefficients) map.texture = nullptr;
    return prepared;
}

} // namespace relief
