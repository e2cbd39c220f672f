// What an AssetCache knows of sequences: blends between two files, and what stays from frame to frame.
#include <cmath>

#include <fmt/format.h>

#include "io/scene/asset_cache.h"
#include "io/scene/blend.h"
#include "relief/error.h"

namespace relief {

namespace {

std::string list_udims(const std::vector<MapTile>& tiles) {
    std::string text;
    for (const MapTile& tile : tiles) text += (text.empty() ? "" : ", ") + std::to_string(tile.udim);
    return text;
}

void require_same_tiles(const SequenceFiles& files, const std::vector<MapTile>& first,
                        const std::vector<MapTile>& second) {
    const std::string a = list_udims(first), b = list_udims(second);
    if (a != b)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("nothing lies between this and {}: tiles {} and {}", files.second, a, b),
                     files.first, "write the same tiles for all frames, or close the shutter"});
}

} // namespace

void AssetCache::forget(int64_t first, int64_t last) {
    const auto is_idle = [&](const auto& entry) {
        const auto& kept = entry.second;
        return kept.value.use_count() <= 1 && (kept.frame < first || kept.frame > last);
    };
    std::erase_if(textures_, is_idle);
    std::erase_if(meshes_, is_idle);
    std::erase_if(finite_, [](const auto& texture) { return texture.expired(); });
}

const SequenceFiles* AssetCache::find_blend(const std::string& file) const {
    const auto found = sequences_.find(file);
    return found == sequences_.end() || found->second.second.empty() ? nullptr : &found->second;
}

std::vector<MapTile> AssetCache::load_blend(const SequenceFiles& files) {
    const int64_t frame = frame_;
    frame_ = files.first_number;
    const std::vector<MapTile> first = load_displacement(files.first);
    frame_ = files.second_number;
    const std::vector<MapTile> second = load_displacement(files.second);
    frame_ = frame;
    require_same_tiles(files, first, second);
    require_finite(first, first.size() > 1), require_finite(second, second.size() > 1);
    std::vector<MapTile> tiles;
    for (size_t k = 0; k < first.size(); ++k) {
        const std::string name = fmt::format("{} {}", name_blend(files), first[k].udim);
        Kept<Texture>& kept = textures_[{name, TextureUse::data, 0, {}}];
        if (!kept.value)
            kept = {blend_textures(*first[k].texture, *second[k].texture, files.weight), kNoFrame};
        finite_.insert(kept.value);
        tiles.push_back({first[k].udim, kept.value});
    }
    return tiles;
}

void AssetCache::warn_of_mesh(const std::vector<std::string>& noticed) {
    for (const std::string& warning : noticed)
        if (told_of_meshes_.insert(warning).second) warnings_.push_back(warning);
}

Mesh AssetCache::read_polygons(const std::string& file, const MeshReadOptions& options) {
    std::vector<std::string> noticed;
    Mesh mesh = load_mesh(resolve(file), options, noticed);
    warn_of_mesh(noticed);
    return mesh;
}

std::shared_ptr<const Mesh> AssetCache::load_kept(const std::string& file, const MeshReadOptions& options,
                                                  int64_t frame) {
    Kept<Mesh>& kept = meshes_[make_key(file, options)];
    kept.frame = frame;
    if (!kept.value) {
        std::vector<std::string> noticed;
        auto mesh = std::make_shared<const Mesh>(load_mesh(resolve(file), options, noticed));
        validate_mesh(*mesh);
        kept.value = std::move(mesh), kept.warnings = std::move(noticed);
    }
    warn_of_mesh(kept.warnings);
    return kept.value;
}

Mesh AssetCache::load_polygons(const std::string& file, const MeshReadOptions& options) {
    if (const SequenceFiles* files = find_blend(file)) {
        const auto first = load_kept(files->first, options, files->first_number);
        const auto second = load_kept(files->second, options, files->second_number);
        return blend_meshes(*first, *second, files->weight);
    }
    const auto known = meshes_.find(make_key(file, options));
    const bool is_kept = known != meshes_.end() && known->second.value;
    const auto sequence = sequences_.find(file);
    if (sequence == sequences_.end() || !(keeps_meshes_ || is_kept)) return read_polygons(file, options);
    return *load_kept(file, options, sequence->second.first_number);
}

void AssetCache::require_finite(const std::vector<MapTile>& tiles, bool is_udim) {
    for (const MapTile& tile : tiles) {
        if (finite_.contains(tile.texture)) continue;
        check_finite(*tile.texture, is_udim ? tile.udim : 0);
        finite_.insert(tile.texture);
    }
}

} // namespace relief
