// Document: another frame of the same file, and what becomes of strokes there.
#include <algorithm>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "viewer/document.h"

namespace relief::viewer {

void Document::note_read_maps() {
    read_.clear();
    note_read_values(scene_);
    for (const Displacement& map : scene_.displacements)
        for (const MapTile& tile : map.tiles) read_[{map.name, tile.udim}] = tile.texture;
}

void Document::note_read_values(const Scene& scene) {
    read_maps_ = scene.displacements;
    read_materials_ = scene.materials;
    read_lights_ = scene.lights;
    read_environment_ = scene.environment;
}

std::string Document::name_source(const Texture& texture) const {
    return texture.file.empty() ? fmt::format("frame {}", input_.frame.value_or(1)) : texture.file;
}

/// Of maps that stay the tiles as they are now; others are kept for when their frame is shown again.
void Document::put_aside(const Scene& next, FrameStrokes& strokes) {
    const auto is_read_again = [&](const TilePlace& place) {
        const auto map = std::ranges::find(next.displacements, place.first, &Displacement::name);
        if (map == next.displacements.end()) return false;
        const auto tile = std::ranges::find(map->tiles, place.second, &MapTile::udim);
        return tile != map->tiles.end() && tile->texture == read_.at(place);
    };
    for (const Displacement& map : scene_.displacements) {
        if (!painted_maps_.contains(map.name)) continue;
        const bool is_saved = !unsaved_.contains(map.name);
        bool is_left = false;
        for (const MapTile& tile : map.tiles) {
            const TilePlace place{map.name, tile.udim};
            if (is_read_again(place)) continue;
            is_left = true;
            if (tile.texture != read_.at(place))
                aside_[{place, name_source(*read_.at(place))}] = {tile.texture, is_saved,
                                                                  input_.frame.value_or(1)};
            painted_.erase(tile.texture.get());
        }
        if (!is_left) continue;
        strokes.has_other_maps = true;
        if (!is_saved) strokes.left.push_back(map);
        painted_maps_.erase(map.name), unsaved_.erase(map.name), changes_.maps.erase(map.name);
    }
}

void Document::take_back(Scene& next, FrameStrokes& strokes) {
    std::set<std::string> returned;
    const auto before = std::exchange(read_, {});
    for (Displacement& map : next.displacements)
        for (MapTile& tile : map.tiles) {
            const TilePlace place{map.name, tile.udim};
            read_[place] = tile.texture;
            const auto read = before.find(place);
            if (read != before.end() && read->second == tile.texture) { // the same map, with its strokes
                const auto mine = std::ranges::find(scene_.displacements, map.name, &Displacement::name);
                tile.texture = std::ranges::find(mine->tiles, tile.udim, &MapTile::udim)->texture;
                continue;
            }
            const auto node = aside_.extract({place, name_source(*tile.texture)});
            if (!node) continue;
            tile.texture = node.mapped().texture;
            painted_maps_.insert(map.name);
            if (!node.mapped().is_saved) unsaved_.insert(map.name), returned.insert(map.name);
        }
    // Maps that were read again from the same file have not left.
    std::erase_if(strokes.left, [&](const Displacement& map) { return returned.erase(map.name) > 0; });
    strokes.returned.assign(returned.begin(), returned.end());
}

FrameStrokes Document::show_frame(ShotFrame next) {
    FrameStrokes strokes;
    if (!next.scene) {
        input_.frame = next.frame;
        return strokes;
    }
    commit();
    make_names_distinct(next.scene->displacements);
    note_read_values(*next.scene);
    changed_.carry(scene_, *next.scene);
    put_aside(*next.scene, strokes);
    input_.frame = next.frame; // of the files that are named by it
    take_back(*next.scene, strokes);
    scene_ = std::move(*next.scene);
    meshes_ = std::move(next.meshes);
    content_ = next.content;
    ++version_;
    return strokes;
}

void Document::follow_frame(SceneValue& value) const {
    const auto follow = [&](auto& was, const auto& read) {
        if (value.index >= read.size()) return;
        const auto before = std::exchange(was, read[value.index]);
        ChangedFields::copy(before, was, value.changed);
    };
    if (auto* const map = std::get_if<Displacement>(&value.value)) {
        follow(*map, read_maps_);
        map->tiles.clear();
    } else if (auto* const material = std::get_if<Material>(&value.value)) {
        follow(*material, read_materials_);
    } else if (auto* const light = std::get_if<Light>(&value.value)) {
        follow(*light, read_lights_);
    } else if (read_environment_) {
        follow(std::get<Environment>(value.value), std::span(&*read_environment_, 1));
    }
}

SceneValue Document::put_back(const Displacement& was, size_t index) {
    return change_displacement(index, [&](Displacement& map) {
        std::vector<MapTile> tiles = std::move(map.tiles);
        map = was;
        map.tiles = std::move(tiles);
    });
}

SceneValue Document::put_back(const Material& was, size_t index) {
    return change_material(index, [&](Material& material) { material = was; });
}

SceneValue Document::put_back(const Environment& was, size_t) {
    const auto before = change_environment([&](Environment& environment) {
        auto texture = std::move(environment.texture);
        environment = was;
        environment.texture = std::move(texture);
    });
    return before.value_or(SceneValue{0, was, 0});
}

SceneValue Document::put_back(const Light& was, size_t index) {
    return change_light(index, [&](Light& light) { light = was; });
}

SceneValue Document::exchange(const SceneValue& value) {
    return std::visit(
        [&](const auto& was) {
            SceneValue before = put_back(was, value.index);
            changed_.of(was, value.index) = value.changed;
            return before;
        },
        value.value);
}

std::vector<int> Document::list_frames_aside() const {
    std::set<int> frames;
    for (const auto& [source, tile] : aside_)
        if (!tile.is_saved) frames.insert(tile.frame);
    return {frames.begin(), frames.end()};
}

} // namespace relief::viewer
