#include "prepare/scene_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "base/udim.h"
#include "image/texel_layout.h"
#include "prepare/camera_enclosure.h"
#include "prepare/editable_scene.h"
#include "prepare/local_origins.h"
#include "prepare/scene_levels.h"
#include "prepare/scene_surfaces.h"
#include "relief/error.h"
#include "surface/map/displacement_map.h"
#include "surface/patch/map_edit.h"

namespace relief {

namespace {

[[noreturn]] void refuse(const MapEdit& edit, std::string message, std::string hint) {
    throw Error(ErrorKind::bad_input,
                {std::move(message),
                 fmt::format("edit of displacement '{}', tile {}", edit.displacement, edit.udim),
                 std::move(hint)});
}

void check_rectangle(const MapEdit& edit, const Texture& map) {
    const Texture& texels = edit.texels;
    if (!is_complete(texels))
        refuse(edit, "the rectangle holds no texels, or not as many as its size says",
               "give stride x width x height values, and 4 - stride zeros");
    if (uint64_t(edit.x) + texels.width > map.width || uint64_t(edit.y) + texels.height > map.height)
        refuse(edit,
               fmt::format("{} x {} texels at ({}, {}) leave the map of {} x {}", texels.width, texels.height,
                           edit.x, edit.y, map.width, map.height),
               "columns and rows count from 0 at the top left");
    if (texels.channel_count == 0 || map.channel_count == 0) return;
    if ((texels.channel_count >= 3) != (map.channel_count >= 3))
        refuse(edit,
               fmt::format("its texels have {} {}, and those of the map {}", texels.channel_count,
                           texels.channel_count == 1 ? "channel" : "channels", map.channel_count),
               map.channel_count >= 3 ? "give vectors" : "give heights, one channel");
}

uint64_t hash_edit(uint64_t hash, const MapEdit& edit) {
    ContentHash sum(hash);
    sum.add(edit.displacement);
    sum.add(std::array{uint32_t(edit.udim), uint32_t(edit.x), uint32_t(edit.y), uint32_t(edit.texels.width),
                       uint32_t(edit.texels.height)});
    sum.add(edit.texels.floats), sum.add(edit.texels.halves);
    return sum.value();
}

uint64_t hash_view(uint64_t hash, const Camera& camera) {
    ContentHash sum(hash);
    const auto& [from, to, up, fov_degrees, aperture_radius, focus_distance, shift, open, close] = camera;
    sum.add(std::vector<Vec3f>{from, to, up});
    sum.add(std::vector<float>{fov_degrees, aperture_radius, focus_distance, shift.x, shift.y, open, close});
    return sum.value();
}

/// What surfaces read of a map.
const Texture* get_image(const PreparedMap& map) {
    return map.coefficients ? map.coefficients.get() : map.texture.get();
}

/// The tiles of one displacement that depend on each other.
struct TiledTexels {
    DisplacementMap map; ///< as TileSurroundings have it
    std::vector<const PreparedMap*> maps;
};

TiledTexels list_tiles_of(const PreparedScene& scene, const PreparedMap& tile) {
    TiledTexels tiles;
    for (const PreparedMap& map : scene.maps) {
        if (map.displacement != tile.displacement) continue;
        tiles.map.tiles.push_back({map.udim, map.texture, nullptr, nullptr});
        tiles.map.neighbours.push_back(map.neighbours);
        tiles.maps.push_back(&map);
    }
    tiles.map.wrap = tile.form.wrap;
    tiles.map.midlevel = {tile.form.outside[0], tile.form.outside[1], tile.form.outside[2]};
    return tiles;
}

/// Tiles from one to another, to the right in the image and below.
std::array<int, 2> find_tile_offset(const PreparedMap& from, const PreparedMap& to) {
    const UdimSquare start = find_udim_square(from.udim), end = find_udim_square(to.udim);
    const int rows = end.row - start.row;
    return {end.column - start.column, from.is_flipped ? rows : -rows};
}

void join(std::vector<uint8_t>& all, const std::vector<uint8_t>& added) {
    for (size_t k = 0; k < all.size(); ++k) all[k] |= added[k];
}

void refuse_tessellated(const SurfaceSettings& settings) {
    if (settings.mode == SurfaceMode::tessellated)
        throw Error(ErrorKind::usage, {"a tessellated surface follows no change of its scene", "session",
                                       "surface.mode = direct"});
}

} // namespace

SceneEditor::SceneEditor(Scene scene, const RenderSettings& settings, SessionUse use)
    : lod_(settings.surface.lod), hash_(scene.hash) {
    refuse_tessellated(settings.surface);
    const Polygonal polygons = use == SessionUse::scenes ? Polygonal::keep : Polygonal::keep_for_views;
    parts_ = prepare_scene_parts(std::move(scene), settings, SceneOrigin::camera, polygons);
    scene_ = parts_.prepared.scene, mips_ = parts_.prepared.mips;
    if (use != SessionUse::scenes) own_maps();
}

std::optional<std::vector<SurfaceChange>> SceneEditor::change_scene(Scene scene,
                                                                    const RenderSettings& settings) {
    hash_ = scene.hash;
    std::optional<std::vector<SurfaceChange>> changes =
        prepare_next_scene(std::move(scene), settings, parts_);
    scene_ = parts_.prepared.scene, mips_ = parts_.prepared.mips;
    return changes;
}

/// The scene's textures may be shared with whoever made it (their mips are not), so each is copied; one
/// after another, since the last user of the old one is often here.
void SceneEditor::own_maps() {
    std::map<const Texture*, const Texture*> copy_of;
    for (Surface& surface : scene_->surfaces)
        for (DisplacementMap::Tile& tile : surface.map.tiles) {
            const auto [place, is_new] = copy_of.try_emplace(tile.texture.get());
            if (is_new) {
                EditableMap map{std::make_shared<Texture>(*tile.texture),
                                std::make_shared<BoundsPyramid>(*tile.pyramid)};
                place->second = map.texture.get();
                textures_[map.texture.get()] = std::move(map);
            }
            tile.texture = textures_[place->second].texture, tile.pyramid = textures_[place->second].pyramid;
        }
    for (PreparedMap& map : scene_->maps) {
        const auto found = copy_of.find(get_image(map));
        if (found == copy_of.end()) {
            map.texture = nullptr;
            continue;
        }
        if (map.coefficients) {
            map.coefficients = textures_[found->second].texture;
            const auto [place, is_new] = copy_of.try_emplace(map.texture.get());
            if (is_new) {
                EditableMap texels{std::make_shared<Texture>(*map.texture), nullptr};
                place->second = texels.texture.get();
                textures_[place->second] = std::move(texels);
            }
        }
        map.texture = textures_[copy_of.at(map.texture.get())].texture;
    }
}

size_t SceneEditor::find_map(const MapEdit& edit) const {
    const auto has_name = [&](const PreparedMap& map) { return map.displacement == edit.displacement; };
    const auto is_meant = [&](const PreparedMap& map) { return has_name(map) && map.udim == edit.udim; };
    const auto found = std::ranges::find_if(scene_->maps, is_meant);
    if (found == scene_->maps.end()) {
        if (std::ranges::none_of(scene_->maps, has_name))
            refuse(edit, "there is no such displacement", "name one of the scene's displacements");
        refuse(edit, "there is no such tile", "only tiles that have a file can change");
    }
    if (!found->texture) refuse(edit, "no object uses it", "name the displacement of an object");
    return size_t(found - scene_->maps.begin());
}

template <class Visit> void SceneEditor::visit_users(const Texture& texture, const Visit& visit) const {
    for (uint32_t index = 0; index < scene_->surfaces.size(); ++index) {
        const Surface& surface = scene_->surfaces[index];
        for (size_t tile = 0; tile < surface.map.tiles.size(); ++tile)
            if (surface.map.tiles[tile].texture.get() == &texture) visit(index, surface, TileIndex(tile));
    }
}

void SceneEditor::check_values(const MapEdit& edit, const Texture& map) const {
    const TexelRectangle all{0, 0, edit.texels.width - 1, edit.texels.height - 1};
    const auto range = find_texel_range(edit.texels, all);
    if (!range) refuse_bad_texel(edit.texels, all);
    visit_users(map, [&](uint32_t, const Surface& surface, uint8_t) {
        check_reach(edit.displacement, surface.map, edit.texels.file, *range);
    });
}

/// Those that show the named image, each texture once.
std::vector<size_t> SceneEditor::find_copies(const MapEdit& edit) const {
    const void* source = scene_->maps[find_map(edit)].source;
    std::map<const Texture*, size_t> copies;
    for (size_t k = 0; k < scene_->maps.size(); ++k) {
        const PreparedMap& map = scene_->maps[k];
        if (map.source == source && map.texture) copies.try_emplace(map.texture.get(), k);
    }
    std::vector<size_t> list;
    for (const auto& [texture, map] : copies) list.push_back(map);
    return list;
}

CheckedEdit SceneEditor::check(const MapEdit& edit) const {
    CheckedEdit checked(edit);
    checked.maps_ = find_copies(edit);
    for (const size_t map : checked.maps_) {
        check_rectangle(edit, *scene_->maps[map].texture);
        for (const PreparedMap& user : scene_->maps)
            if (user.texture == scene_->maps[map].texture) check_values(edit, *get_image(user));
    }
    return checked;
}

void SceneEditor::paint(const MapEdit& edit, size_t named, std::vector<Reading>& readings) {
    PreparedMap& prepared = scene_->maps[named];
    EditableMap& map = textures_.at(prepared.texture.get());
    copy_texels(edit.texels, *map.texture, edit.x, edit.y);
    const TexelRectangle changed = prepared.gutter.follow(
        *map.texture, {edit.x, edit.y, edit.x + edit.texels.width - 1, edit.y + edit.texels.height - 1});
    if (map.pyramid) map.pyramid->update(*map.texture, changed);
    std::map<const MipChain*, std::vector<TexelRectangle>> rectangles{{nullptr, {changed}}};
    for (size_t user = 0; user < scene_->maps.size(); ++user) {
        MipChain* mips = mips_[user].get();
        if (scene_->maps[user].texture != prepared.texture || !mips || rectangles.contains(mips)) continue;
        std::vector<TexelRectangle>& all = rectangles[mips];
        all = mips->update(*map.texture, changed);
        all.insert(all.begin(), changed);
    }
    visit_users(*map.texture, [&](uint32_t index, const Surface& surface, TileIndex tile) {
        readings.push_back({index, tile, rectangles.at(surface.map.tiles[tile].mips.get())});
    });
    update_splines(prepared.texture, changed, readings);
}

/// Makes coefficients anew for the maps that have theirs from `texels`, and for the tiles beside them.
void SceneEditor::update_splines(const std::shared_ptr<const Texture>& texels, const TexelRectangle& changed,
                                 std::vector<Reading>& readings) {
    std::set<const Texture*> done;
    const auto follow = [&](const PreparedMap& map, const auto& update) {
        if (!map.coefficients || !done.insert(map.coefficients.get()).second) return;
        EditableMap& image = textures_.at(map.coefficients.get());
        const std::optional<TexelRectangle> reached = update(*image.texture);
        if (!reached) return;
        image.pyramid->update(*image.texture, *reached);
        visit_users(*image.texture, [&](uint32_t index, const Surface&, TileIndex tile) {
            readings.push_back({index, tile, {*reached}});
        });
    };
    for (const PreparedMap& map : scene_->maps) {
        if (map.texture != texels) continue;
        if (!map.has_neighbours) {
            follow(map, [&](Texture& coefficients) {
                return std::optional(update_spline(*texels, map.form, changed, coefficients));
            });
            continue;
        }
        const TiledTexels tiles = list_tiles_of(*scene_, map);
        for (size_t k = 0; k < tiles.maps.size(); ++k) {
            const PreparedMap& other = *tiles.maps[k];
            const TileSurroundings surroundings{tiles.map, TileIndex(k)};
            follow(other, [&](Texture& coefficients) {
                return update_spline_beside(*other.texture, other.form, changed, find_tile_offset(other, map),
                                            coefficients, surroundings);
            });
        }
    }
}

/// One a surface.
std::vector<SurfaceChange> SceneEditor::find_changes(const std::vector<Reading>& readings) const {
    std::vector<SurfaceChange> changes;
    for (const Reading& reading : readings) {
        const auto is_same = [&](const SurfaceChange& c) { return c.surface == reading.surface; };
        const auto found = std::ranges::find_if(changes, is_same);
        const std::vector<uint8_t> touched =
            find_touched_patches(scene_->surfaces[reading.surface], reading.tile, reading.rectangles);
        if (found == changes.end())
            changes.push_back({reading.surface, touched, {}});
        else
            join(found->is_changed, touched);
    }
    return changes;
}

/// To the length of the largest cell of each patch in any instance, in parts of the patch.
void SceneEditor::extend_reach(uint32_t surface, std::vector<float>& reach) const {
    for (const Instance& instance : scene_->instances) {
        if (instance.surface != surface) continue;
        for (size_t patch = 0; patch < reach.size(); ++patch) {
            const PatchLevels levels = instance.levels->at(uint32_t(patch));
            const int coarsest = lod_ == LodRule::ray
                                     ? 0
                                     : std::min<int>(levels.patch, *std::ranges::min_element(levels.edge));
            reach[patch] = std::max(reach[patch], std::ldexp(1.0f, -coarsest));
        }
    }
}

/// Shading normals may read the map a cell beyond the patch, of its old levels or of its new ones.
void SceneEditor::find_different_patches(const std::vector<Reading>& readings,
                                         const std::vector<float>& reach, SurfaceChange& change) const {
    change.looks_different = change.is_changed;
    for (const Reading& reading : readings)
        if (reading.surface == change.surface)
            join(change.looks_different, find_touched_patches(scene_->surfaces[change.surface], reading.tile,
                                                              reading.rectangles, reach));
}

/// Other levels may ask for other copies of the map, also in patches beside those that changed.
void SceneEditor::update_mips(std::vector<SurfaceChange>& changes) {
    for (SurfaceChange& change : changes) {
        Surface& surface = scene_->surfaces[change.surface];
        const std::vector<uint32_t> mips = choose_scene_mips(*scene_, change.surface);
        for (size_t patch = 0; patch < mips.size(); ++patch)
            if (mips[patch] != surface.mips[patch]) change.is_changed[patch] = 1;
        surface.mips = mips;
    }
}

void SceneEditor::update_levels(const std::vector<SurfaceChange>& changes) {
    for (Instance& instance : scene_->instances)
        for (const SurfaceChange& change : changes) {
            if (instance.surface != change.surface || instance.levels->is_uniform()) continue;
            instance.lines = nullptr;
            LevelField field = *instance.levels;
            field.update(scene_->surfaces[change.surface], instance.world_from_object, scene_->levels,
                         change.is_changed);
            instance.levels = std::make_shared<const LevelField>(std::move(field));
        }
}

std::vector<SurfaceChange> SceneEditor::apply(const CheckedEdit& edit) {
    std::vector<Reading> readings;
    for (const size_t map : edit.maps_) paint(edit.edit_, map, readings);
    std::vector<SurfaceChange> changes = find_changes(readings);
    std::vector<std::vector<float>> reaches;
    for (const SurfaceChange& change : changes) {
        reaches.emplace_back(change.is_changed.size(), 0.0f);
        extend_reach(change.surface, reaches.back());
    }
    update_levels(changes);
    update_mips(changes);
    // Rays from far away are moved another way then, to all of the surface.
    for (SurfaceChange& change : changes)
        if (update_reach(*scene_, change.surface)) std::ranges::fill(change.is_changed, uint8_t(1));
    for (size_t k = 0; k < changes.size(); ++k) {
        extend_reach(changes[k].surface, reaches[k]);
        find_different_patches(readings, reaches[k], changes[k]);
    }
    scene_->may_enclose_camera = may_enclose_camera(*scene_);
    hash_ = hash_edit(hash_, edit.edit_);
    return changes;
}

std::vector<SurfaceChange> SceneEditor::change_view(const Camera& camera, const RenderSettings& settings,
                                                    uint64_t scene_hash) {
    PreparedScene& scene = *scene_;
    // What a change before this one, which was stopped, made but did not finish is finished now.
    for (const uint32_t surface : follow_view(parts_, make_level_config(camera, settings)))
        if (std::ranges::find(remade_, surface) == remade_.end()) remade_.push_back(surface);
    const std::vector<uint32_t>& remade = remade_;
    for (const uint32_t surface : remade) {
        update_reach(scene, surface);
        for (Instance& instance : scene.instances)
            if (instance.surface == surface) instance.lines = nullptr;
    }
    if (!remade.empty()) add_tangents(scene);
    scene.camera = camera;
    scene.camera.from = camera.from - scene.origin, scene.camera.to = camera.to - scene.origin;
    scene.width = settings.image.width, scene.height = settings.image.height;
    update_scene_levels(scene, settings, ViewsToCome::many);
    std::vector<SurfaceChange> changes;
    for (uint32_t k = 0; k < scene.surfaces.size(); ++k)
        if (scene.surfaces[k].has_displacement && std::ranges::find(remade, k) == remade.end())
            changes.push_back({k, std::vector<uint8_t>(scene.surfaces[k].patch_count()), {}});
    update_mips(changes);
    std::erase_if(changes, [](const SurfaceChange& c) {
        return std::ranges::find(c.is_changed, 1) == c.is_changed.end();
    });
    for (const uint32_t surface : remade) {
        scene.surfaces[surface].mips = choose_scene_mips(scene, surface);
        changes.push_back({surface, {}, {}, true});
    }
    remade_.clear();
    for (SurfaceChange& change : changes) change.looks_different = change.is_changed;
    scene.may_enclose_camera = may_enclose_camera(scene);
    hash_ = scene_hash != 0 ? scene_hash : hash_view(hash_, camera);
    return changes;
}

} // namespace relief
