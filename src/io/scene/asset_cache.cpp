#include "io/scene/asset_cache.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/stop_request.h"
#include "formulas/bsdf.h"
#include "formulas/tonemap.h"
#include "image/texel_layout.h"
#include "io/file_system.h"
#include "io/picture/color_space.h"
#include "io/picture/exr_header.h"
#include "io/scene/tile_names.h"
#include "relief/error.h"
#include "relief/half.h"
#include "relief/io.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

bool is_finite_half(uint16_t bits) { return (bits & 0x7c00) != 0x7c00; }

/// `visit` gets the places where texels begin.
template <class Visit> void visit_texels(const Texture& texture, const Visit& visit) {
    const size_t count = size_t(texture.width) * texture.height;
    for (size_t k = 0; k < count; ++k) visit(k * texture.stride);
}

void decode_colors(Texture& texture) {
    const bool is_integer =
        texture.source_type == SampleType::uint8 || texture.source_type == SampleType::uint16;
    if (!is_integer) return;
    const bool is_grey = texture.channel_count < 3;
    visit_texels(texture, [&](size_t place) {
        for (size_t c = 0; c < (is_grey ? 1 : 3); ++c)
            texture.floats[place + c] = scalar::decode_srgb(texture.floats[place + c]);
    });
}

/// A picture with one channel is grey: it counts for red, green and blue.
void spread_grey(Texture& texture) {
    if (texture.channel_count >= 3 || texture.stride == 1) return;
    const auto spread = [&](auto& values) {
        if (values.empty()) return;
        visit_texels(texture, [&](size_t k) { values[k + 1] = values[k + 2] = values[k]; });
    };
    spread(texture.floats), spread(texture.halves);
}

void move_first(Texture& texture, uint32_t channel) {
    if (channel >= texture.channel_count)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("no channel {}: there are {}", "rgba"[channel], texture.channel_count),
                     texture.file, "name another channel"});
    const auto move = [&](auto& values) {
        if (!values.empty())
            visit_texels(texture, [&](size_t k) { std::swap(values[k], values[k + channel]); });
    };
    move(texture.floats), move(texture.halves);
}

float find_luminance(const Texture& texture, size_t texel) {
    if (texture.channel_count < 3) return texture.floats[texel];
    return scalar::luminance({texture.floats[texel], texture.floats[texel + 1], texture.floats[texel + 2]});
}

/// The first channel alone is left.
void keep_first(Texture& texture) {
    const auto keep = [&](auto& values) {
        if (values.empty()) return;
        size_t next = 0;
        visit_texels(texture, [&](size_t k) { values[next++] = values[k]; });
        values.resize(next);
        values.resize(next + 3); // zeros
        values.shrink_to_fit();
    };
    keep(texture.floats), keep(texture.halves);
    texture.channel_count = texture.stride = 1;
}

/// One channel is left, which counts for red, green and blue.
void pick_channel(Texture& texture, uint32_t channel) {
    if (channel == kLuminanceChannel) {
        for (const uint16_t bits : texture.halves) texture.floats.push_back(half_to_float(bits));
        texture.halves.clear();
        visit_texels(texture, [&](size_t k) { texture.floats[k] = find_luminance(texture, k); });
    } else if (channel > 0) {
        move_first(texture, channel);
    }
    keep_first(texture);
}

bool lift_negatives(Texture& texture) {
    bool has_lifted = false;
    const uint32_t stride = texture.stride; // a fourth channel is no radiance
    for (size_t i = 0; i < texture.floats.size(); ++i)
        if (i % stride != 3 && texture.floats[i] < 0) texture.floats[i] = 0, has_lifted = true;
    for (size_t i = 0; i < texture.halves.size(); ++i)
        if (i % stride != 3 && texture.halves[i] > 0x8000) texture.halves[i] = 0, has_lifted = true;
    return has_lifted;
}

} // namespace

float get_texel(const Texture& texture, uint32_t x, uint32_t y, uint32_t channel) {
    return load_channel(texture, texture.find_texel(x, y), channel);
}

void check_finite(const Texture& texture, int udim) {
    const size_t count = size_t(texture.width) * texture.height;
    for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < std::min(3u, texture.stride); ++c) {
            const size_t place = texture.stride * i + c;
            const bool is_bad = texture.floats.empty() ? !is_finite_half(texture.halves[place])
                                                       : !std::isfinite(texture.floats[place]);
            if (!is_bad) continue;
            const auto x = uint32_t(i % texture.width), y = uint32_t(i / texture.width);
            const std::string tile = udim > 0 ? fmt::format(", tile {}", udim) : std::string();
            const bool is_nan = std::isnan(get_texel(texture, x, y, uint32_t(c)));
            const std::string channel =
                texture.channel_count < 3 ? std::string() : fmt::format(" in channel {}", "RGB"[c]);
            throw Error(ErrorKind::bad_input,
                        {fmt::format("{}{}", is_nan ? "NaN" : "infinity", channel),
                         fmt::format("{}, pixel ({}, {}){}", texture.file, x, y, tile),
                         "repair the pixel, for example by painting over it, and export again"});
        }
    }
}

fs::path AssetCache::resolve(const std::string& file) const {
    const fs::path path(file);
    const bool is_whole = path.is_absolute() || folder_.empty();
    return find_with_slashes(is_whole ? path : folder_ / path).lexically_normal();
}

std::optional<Mesh> AssetCache::take_mesh(const std::string& file) {
    const auto found = given_.meshes.find(file);
    if (found == given_.meshes.end()) return std::nullopt;
    if (found->second.face_sizes.empty() && found->second.positions.empty())
        throw Error(ErrorKind::bad_input, {"is empty, or named twice", file, "a mesh in memory is one mesh"});
    return std::exchange(found->second, Mesh{});
}

std::shared_ptr<const Texture> AssetCache::find_given(const std::string& file) const {
    const auto found = given_.textures.find(file);
    return found == given_.textures.end() ? nullptr : found->second;
}

std::optional<AssetCache::FileStamp> AssetCache::read_stamp(const fs::path& file) {
    std::error_code code;
    FileStamp stamp{fs::last_write_time(file, code), 0};
    if (!code) stamp.bytes = fs::file_size(file, code);
    return code ? std::nullopt : std::optional(stamp);
}

void AssetCache::change_given(SceneAssets given) {
    std::swap(given_, given);
    std::erase_if(textures_, [&](const auto& entry) {
        const auto& [key, kept] = entry;
        if (kept.stamp) return kept.stamp != read_stamp(split_picture_name(std::get<0>(key)).file);
        const auto before = given.textures.find(std::get<0>(key));
        return before == given.textures.end() || find_given(before->first) != before->second;
    });
    forget(1, 0);
    meshes_.clear(), sequences_.clear();
}

const uint64_t* AssetCache::find_kept(const std::string& mesh) const {
    const auto found = given_.kept_meshes.find(mesh);
    return found == given_.kept_meshes.end() ? nullptr : &found->second;
}

std::shared_ptr<const Texture> AssetCache::load(const std::string& file, TextureUse use, uint32_t channel,
                                                const std::string& space) {
    const std::shared_ptr<const Texture> given = find_given(file);
    if (given && !is_complete(*given))
        throw Error(ErrorKind::bad_input, {"holds another number of texels than its size and its stride say",
                                           file, "give value_count() values"});
    if (given && use == TextureUse::data && channel == 0) return given;
    const fs::path path = given ? fs::path(file) : resolve(file);
    const TextureKey key(path.string(), use, channel, space);
    Kept<Texture>& cached = textures_[key];
    cached.frame = frame_;
    if (!cached.value) {
        stop_if_asked();
        if (!given) cached.stamp = read_stamp(split_picture_name(path.string()).file);
        auto texture = std::make_shared<Texture>(given ? *given : read_texture(path));
        cached.value = decode(std::move(texture), use, channel, space);
    }
    for (const std::string& warning : cached.value->warnings)
        if (told_of_pictures_.insert(warning).second) warnings_.push_back(warning);
    return cached.value;
}

std::string AssetCache::name_layer(const std::string& file, const std::string& part,
                                   const std::string& layer) {
    const auto join = [&](const std::string& name) {
        return name.empty() ? name : join_picture_name({name, part, layer});
    };
    const auto found = sequences_.find(file);
    if (found == sequences_.end()) return join(file);
    SequenceFiles files = found->second;
    files.first = join(files.first), files.second = join(files.second);
    add_sequence(files);
    return name_blend(files);
}

std::shared_ptr<const Texture> AssetCache::decode(std::shared_ptr<Texture> texture, TextureUse use,
                                                  uint32_t channel, const std::string& space) {
    if (use == TextureUse::number) {
        check_finite(*texture, 0);
        if (!space.empty()) decode_texture(space, *texture);
        pick_channel(*texture, channel);
        return texture;
    }
    if (channel > 0) move_first(*texture, channel);
    if (use == TextureUse::data) return texture;
    check_finite(*texture, 0);
    if (use == TextureUse::radiance && texture->is_cube_map)
        throw Error(
            ErrorKind::bad_input,
            {"is a map of a cube's faces (envmap), and surroundings are read by longitude and latitude",
             texture->file, "OpenEXR's command line: exrenvmap -l IN.exr OUT.exr"});
    if (space.empty() && use != TextureUse::vector && texture->colour_tag == kOtherPrimariesTag)
        warnings_.push_back(fmt::format(
            "{}: its header names primaries of another colour space ({}), but its values are taken for "
            "linear Rec.709: write color_space beside the file in a scene file, such as acescg, or "
            "linear if the header is wrong",
            texture->file, texture->colour_tag));
    if (use == TextureUse::color && space.empty()) {
        if (texture->colour_tag == kLinearTag)
            warnings_.push_back(fmt::format("{}: its header says that its values are linear ({}), but "
                                            "integers that are colours are decoded from "
                                            "sRGB: write color_space beside the file in a scene file: "
                                            "linear, or srgb if the header is wrong",
                                            texture->file, texture->colour_tag));
        decode_colors(*texture);
    }
    if (use != TextureUse::vector) spread_grey(*texture);
    if (!space.empty()) decode_texture(space, *texture);
    if (use == TextureUse::radiance && lift_negatives(*texture))
        warnings_.push_back(fmt::format("{}: negative radiance counts as 0", texture->file));
    return texture;
}

std::vector<MapTile> AssetCache::load_given_tiles(const std::string& pattern, TextureUse use,
                                                  uint32_t channel, const std::string& space) {
    std::vector<std::string> names;
    for (const auto& [name, texture] : given_.textures) names.push_back(name);
    std::vector<MapTile> tiles;
    for (const auto& [udim, name] : choose_tiles(pattern, names))
        tiles.push_back({udim, load(name, use, channel, space)});
    return tiles;
}

std::vector<MapTile> AssetCache::load_tiles(const std::string& file, TextureUse use, uint32_t channel,
                                            const std::string& space) {
    if (const SequenceFiles* files = find_blend(file)) return load_blend(*files);
    std::vector<MapTile> tiles;
    if (!has_tile_token(file)) {
        if (!find_given(file)) refuse_wildcard(resolve(file));
        tiles.push_back({1001, load(file, use, channel, space)});
        if (find_given(file) || !single_tiles_.insert(file).second) return tiles;
        const PictureName name = split_picture_name(resolve(file).string());
        if (const std::string pattern = find_tile_pattern(name.file); !pattern.empty())
            warnings_.push_back(
                fmt::format("{}: is one tile of several, and the only one read; name them all "
                            "as {}",
                            file, pattern));
        return tiles;
    }
    if (tiles = load_given_tiles(file, use, channel, space); !tiles.empty()) return tiles;
    PictureName name = split_picture_name(resolve(file).string());
    for (const auto& [udim, path] : find_tiles(name.file)) {
        name.file = fs::absolute(path).string();
        tiles.push_back({udim, load(join_picture_name(name), use, channel, space)});
    }
    return tiles;
}

} // namespace relief
