#include "relief/session.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "api/make_engine.h"
#include "api/picture_report.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "prepare/space_warnings.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"
#include "surface/map/displacement_map.h"
#include "surface/patch/map_edit.h"

namespace relief {

namespace {

/// A map as the session holds it.
struct EditableMap {
    std::shared_ptr<Texture> texture;
    std::shared_ptr<BoundsPyramid> pyramid;
};

[[noreturn]] void refuse(const MapEdit& edit, std::string message, std::string hint) {
    throw Error(ErrorKind::bad_input,
                {std::move(message),
                 fmt::format("edit of displacement '{}', tile {}", edit.displacement, edit.udim),
                 std::move(hint)});
}

void check_rectangle(const MapEdit& edit, const Texture& map) {
    const Texture& texels = edit.texels;
    const size_t count = size_t(4) * texels.width * texels.height;
    if (count == 0 || texels.floats.size() + texels.halves.size() != count)
        refuse(edit, "the rectangle holds no texels, or not as many as its size says",
               "give 4 x width x height values");
    if (uint64_t(edit.x) + texels.width > map.width || uint64_t(edit.y) + texels.height > map.height)
        refuse(edit,
               fmt::format("{} x {} texels at ({}, {}) leave the map of {} x {}", texels.width, texels.height,
                           edit.x, edit.y, map.width, map.height),
               "columns and rows count from 0 at the top left");
}

uint64_t hash_edit(uint64_t hash, const MapEdit& edit) {
    const auto add = [&](uint64_t word) { // FNV-1a (Fowler, Noll, Vo 1991), a word a step
        hash = (hash ^ word) * 0x100000001b3ull;
        hash ^= hash >> 29;
    };
    for (const char letter : edit.displacement) add(uint8_t(letter));
    add(uint64_t(uint32_t(edit.udim))), add(edit.x), add(edit.y), add(edit.texels.width);
    for (const float value : edit.texels.floats) add(std::bit_cast<uint32_t>(value));
    for (const uint16_t value : edit.texels.halves) add(value);
    return hash;
}

} // namespace

struct Session::Implementation {
    RenderSettings settings;
    uint64_t scene_hash = 0;
    double prepare_s = 0; ///< since the last picture
    std::shared_ptr<PreparedScene> prepared;
    std::unique_ptr<Engine> engine;
    std::unique_ptr<Film> film; ///< holds the last picture; null: none that the engine could go on with
    std::map<const Texture*, EditableMap> maps; ///< by the texture itself

    Implementation(Scene scene, const RenderSettings& given) : settings(given), scene_hash(scene.hash) {
        validate_settings(settings);
        validate_method(settings, scene.camera);
        if (settings.surface.mode == SurfaceMode::tessellated)
            throw Error(ErrorKind::usage, {"a tessellated surface does not follow edits of its map",
                                           "session", "render it directly"});
        const Timer timer;
        with_threads(settings.device.threads, [&] {
            prepared = prepare_with_warnings(std::move(scene), settings);
            own_maps();
            start_engine();
        });
        prepare_s = timer.seconds();
    }

    void start_engine() {
        film.reset(), engine.reset(); // a device need not hold two
        engine = make_engine(prepared, settings);
        engine->expect_changes();
    }

    /// What changed since the last picture is traced anew, the rest kept.
    bool trace_picture(RenderObserver* observer) {
        if (film) return engine->refresh(*film, observer);
        auto fresh = std::make_unique<Film>(settings.image.width, settings.image.height, settings.image.crop,
                                            settings.image.layers);
        const bool is_complete = engine->render(*fresh, observer);
        film = std::move(fresh);
        return is_complete;
    }

    /// The scene's textures may be shared with whoever made it (their mips are not), so each is copied; one
    /// after another, since the last user of the old one is often here.
    void own_maps() {
        std::map<const Texture*, const Texture*> copy_of;
        for (Surface& surface : prepared->surfaces)
            for (DisplacementMap::Tile& tile : surface.map.tiles) {
                const auto [place, is_new] = copy_of.try_emplace(tile.texture.get());
                if (is_new) {
                    EditableMap map{std::make_shared<Texture>(*tile.texture),
                                    std::make_shared<BoundsPyramid>(*tile.pyramid)};
                    place->second = map.texture.get();
                    maps[map.texture.get()] = std::move(map);
                }
                tile.texture = maps[place->second].texture, tile.pyramid = maps[place->second].pyramid;
            }
        for (PreparedMap& map : prepared->maps) {
            const auto found = copy_of.find(map.texture.get());
            map.texture = found == copy_of.end() ? nullptr : maps[found->second].texture;
        }
    }

    PreparedMap& find_map(const MapEdit& edit) {
        const auto has_name = [&](const PreparedMap& map) { return map.displacement == edit.displacement; };
        const auto is_meant = [&](const PreparedMap& map) { return has_name(map) && map.udim == edit.udim; };
        const auto found = std::find_if(prepared->maps.begin(), prepared->maps.end(), is_meant);
        if (found == prepared->maps.end()) {
            if (std::none_of(prepared->maps.begin(), prepared->maps.end(), has_name))
                refuse(edit, "there is no such displacement", "name one of the scene's displacements");
            refuse(edit, "there is no such tile", "only tiles that have a file can change");
        }
        if (!found->texture) refuse(edit, "no object uses it", "name the displacement of an object");
        return *found;
    }

    template <class Visit> void visit_users(const Texture& texture, const Visit& visit) {
        for (uint32_t index = 0; index < prepared->surfaces.size(); ++index) {
            Surface& surface = prepared->surfaces[index];
            for (size_t tile = 0; tile < surface.map.tiles.size(); ++tile)
                if (surface.map.tiles[tile].texture.get() == &texture) visit(index, surface, uint8_t(tile));
        }
    }

    void check_values(const MapEdit& edit, const Texture& map) {
        const TexelRectangle all{0, 0, edit.texels.width - 1, edit.texels.height - 1};
        const auto range = find_texel_range(edit.texels, all);
        if (!range) refuse_bad_texel(edit.texels, all);
        visit_users(map, [&](uint32_t, const Surface& surface, uint8_t) {
            check_reach(edit.displacement, surface.map, edit.texels.file, *range);
        });
    }

    /// Those that show the named image, each texture once.
    std::vector<PreparedMap*> find_copies(const MapEdit& edit) {
        const void* source = find_map(edit).source;
        std::map<const Texture*, PreparedMap*> copies;
        for (PreparedMap& map : prepared->maps)
            if (map.source == source && map.texture) copies.try_emplace(map.texture.get(), &map);
        std::vector<PreparedMap*> list;
        for (const auto& [texture, map] : copies) list.push_back(map);
        return list;
    }

    /// What the edit changes.
    std::vector<PreparedMap*> check(const MapEdit& edit) {
        std::vector<PreparedMap*> copies = find_copies(edit);
        for (const PreparedMap* map : copies) {
            check_rectangle(edit, *map->texture);
            check_values(edit, *map->texture);
        }
        return copies;
    }

    /// What a surface reads of an image, and where that has changed, in the image and its copies.
    struct Reading {
        uint32_t surface;
        uint8_t tile;
        std::vector<TexelRectangle> rectangles;
    };

    void paint(const MapEdit& edit, PreparedMap& named, std::vector<Reading>& readings) {
        EditableMap& map = maps.at(named.texture.get());
        copy_texels(edit.texels, *map.texture, edit.x, edit.y);
        const TexelRectangle changed = named.gutter.follow(
            *map.texture, {edit.x, edit.y, edit.x + edit.texels.width - 1, edit.y + edit.texels.height - 1});
        map.pyramid->update(*map.texture, changed);
        std::map<const MipChain*, std::vector<TexelRectangle>> rectangles{{nullptr, {changed}}};
        for (const PreparedMap& user : prepared->maps) {
            if (user.texture != named.texture || !user.mips || rectangles.contains(user.mips.get())) continue;
            std::vector<TexelRectangle>& all = rectangles[user.mips.get()];
            all = user.mips->update(*map.texture, changed);
            all.insert(all.begin(), changed);
        }
        visit_users(*map.texture, [&](uint32_t index, const Surface& surface, uint8_t tile) {
            readings.push_back({index, tile, rectangles.at(surface.map.tiles[tile].mips.get())});
        });
    }

    /// One a surface.
    std::vector<SurfaceChange> find_changes(const std::vector<Reading>& readings) const {
        std::vector<SurfaceChange> changes;
        for (const Reading& reading : readings) {
            const auto is_same = [&](const SurfaceChange& c) { return c.surface == reading.surface; };
            const auto found = std::find_if(changes.begin(), changes.end(), is_same);
            const std::vector<uint8_t> touched =
                find_touched_patches(prepared->surfaces[reading.surface], reading.tile, reading.rectangles);
            if (found == changes.end())
                changes.push_back({reading.surface, touched, {}});
            else
                join(found->is_changed, touched);
        }
        return changes;
    }

    static void join(std::vector<uint8_t>& all, const std::vector<uint8_t>& added) {
        for (size_t k = 0; k < all.size(); ++k) all[k] |= added[k];
    }

    /// To the length of the largest cell of each patch in any instance, in parts of the patch.
    void extend_reach(uint32_t surface, std::vector<float>& reach) const {
        for (const Instance& instance : prepared->instances) {
            if (instance.surface != surface) continue;
            for (size_t patch = 0; patch < reach.size(); ++patch) {
                const PatchLevels levels = instance.levels->at(uint32_t(patch));
                const int coarsest = settings.surface.lod == LodRule::ray
                                         ? 0
                                         : std::min<int>(levels.patch, *std::min_element(levels.edge.begin(),
                                                                                         levels.edge.end()));
                reach[patch] = std::max(reach[patch], std::ldexp(1.0f, -coarsest));
            }
        }
    }

    EditReport apply(const MapEdit& edit) {
        const Timer timer;
        const std::vector<PreparedMap*> copies = check(edit);
        // Whatever fails from here on, no picture is gone on with.
        std::unique_ptr<Film> kept = std::move(film);
        std::vector<Reading> readings;
        for (PreparedMap* map : copies) paint(edit, *map, readings);
        std::vector<SurfaceChange> changes = find_changes(readings);
        std::vector<std::vector<float>> reaches;
        for (const SurfaceChange& change : changes) {
            reaches.emplace_back(change.is_changed.size(), 0.0f);
            extend_reach(change.surface, reaches.back());
        }
        update_levels(changes);
        update_mips(changes);
        for (size_t k = 0; k < changes.size(); ++k) {
            extend_reach(changes[k].surface, reaches[k]);
            find_different_patches(readings, reaches[k], changes[k]);
        }
        if (engine->follow(changes))
            film = std::move(kept);
        else
            start_engine();
        scene_hash = hash_edit(scene_hash, edit);
        EditReport report;
        for (const SurfaceChange& change : changes)
            report.patches += uint64_t(std::count(change.is_changed.begin(), change.is_changed.end(), 1));
        report.seconds = timer.seconds();
        prepare_s += report.seconds;
        return report;
    }

    /// Shading normals may read the map a cell beyond the patch, of its old levels or of its new ones.
    void find_different_patches(const std::vector<Reading>& readings, const std::vector<float>& reach,
                                SurfaceChange& change) const {
        change.looks_different = change.is_changed;
        for (const Reading& reading : readings)
            if (reading.surface == change.surface)
                join(change.looks_different, find_touched_patches(prepared->surfaces[change.surface],
                                                                  reading.tile, reading.rectangles, reach));
    }

    /// Other levels may ask for other copies of the map, also in patches beside those that changed.
    void update_mips(std::vector<SurfaceChange>& changes) {
        for (SurfaceChange& change : changes) {
            Surface& surface = prepared->surfaces[change.surface];
            const std::vector<uint32_t> mips = choose_scene_mips(*prepared, change.surface);
            for (size_t patch = 0; patch < mips.size(); ++patch)
                if (mips[patch] != surface.mips[patch]) change.is_changed[patch] = 1;
            surface.mips = mips;
        }
    }

    void update_levels(const std::vector<SurfaceChange>& changes) {
        for (Instance& instance : prepared->instances)
            for (const SurfaceChange& change : changes) {
                if (instance.surface != change.surface || instance.levels->is_uniform()) continue;
                LevelField field = *instance.levels;
                field.update(prepared->surfaces[change.surface], instance.world_from_object, prepared->levels,
                             change.is_changed);
                instance.levels = std::make_shared<const LevelField>(std::move(field));
            }
    }
};

Session::Session(Scene scene, const RenderSettings& settings)
    : implementation_(std::make_unique<Implementation>(std::move(scene), settings)) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

RenderResult Session::render(RenderObserver* observer) {
    Implementation& self = *implementation_;
    RenderResult result;
    Statistics& statistics = result.statistics;
    const Timer total;
    with_threads(self.settings.device.threads, [&] {
        const Timer timer;
        result.is_complete = self.trace_picture(observer);
        statistics.render_s = timer.seconds();
        statistics.prepare_s = std::exchange(self.prepare_s, 0);
        self.engine->add_statistics(statistics);
        statistics.first_image_s += statistics.prepare_s;
        statistics.threads = thread_count();
        statistics.ray_buffers_bytes += self.film->byte_count();
        statistics.warnings = self.prepared->warnings;
        count_scene(*self.prepared, statistics);
        result.image = self.film->resolve();
    });
    add_metadata(self.settings, self.scene_hash, result.is_complete, result.image);
    statistics.total_s = statistics.prepare_s + total.seconds();
    statistics.peak_resident_bytes = peak_resident_bytes();
    return result;
}

EditReport Session::edit(const MapEdit& edit) {
    EditReport report;
    with_threads(implementation_->settings.device.threads, [&] { report = implementation_->apply(edit); });
    return report;
}

void Session::check(const MapEdit& edit) const {
    with_threads(implementation_->settings.device.threads, [&] { implementation_->check(edit); });
}

} // namespace relief
