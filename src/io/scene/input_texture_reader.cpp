#include "io/scene/input_texture_reader.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/scene/scene_keys.h"
#include "io/scene/tile_names.h"
#include "scene/displacement_conventions.h"
#include "scene/material_inputs.h"
#include "scene/words.h"

namespace relief {

namespace {

constexpr double kFarthestUv = 1e6;

/// One number stands for both.
Vec2f read_pair(const JsonNode& node) {
    if (node.is_array()) return node.as_vec2(-kFarthestUv, kFarthestUv);
    const float both = node.as_float(-kFarthestUv, kFarthestUv);
    return {both, both};
}

void check_texture_keys(const JsonNode& node, const MaterialInputKind& kind, bool is_own_key) {
    if (const auto uv_set = node.find("uv_set"); uv_set && kind.input == MaterialInput::normal)
        uv_set->fail("directions of a normal map go by the uvs that the mesh is read with",
                     "name its set as uv_set of the mesh, and the other one as that of the other textures");
    if (kind.input == MaterialInput::normal)
        node.check_keys(scene_keys::kNormalTexture);
    else if (!is_own_key)
        node.check_keys(scene_keys::kInputTexture);
    else if (kind.is_color())
        node.check_keys(scene_keys::kColorTexture);
    else
        node.check_keys(scene_keys::kDataTexture);
}

void read_place(const JsonNode& node, InputTexture& texture) {
    if (const auto scale = node.find("uv_scale")) texture.uv_scale = read_pair(*scale);
    if (const auto offset = node.find("uv_offset")) texture.uv_offset = read_pair(*offset);
    if (const auto uv_set = node.find("uv_set")) texture.uv_set = int(uv_set->as_integer(0, kMaxUvSet));
    const auto wrap = node.find("wrap");
    if (!wrap) return;
    if (texture.is_udim) wrap->fail("each of several tiles ends with its own texels", "leave wrap out");
    const std::string name = wrap->as_string();
    texture.wrap = wrap->with_place([&] { return parse_word<WrapMode>(name); });
}

/// Which of a texel's values is the number.
uint32_t read_channel(const JsonNode& node) {
    constexpr std::string_view kNames[] = {"r", "g", "b", "a", "luminance"};
    const std::string name = node.as_string();
    const auto found = std::find(std::begin(kNames), std::end(kNames), name);
    if (found == std::end(kNames))
        node.fail(fmt::format("unknown channel '{}'", name), "one of r, g, b, a, luminance");
    return uint32_t(found - std::begin(kNames));
}

/// `none` where there is none.
MapFilter read_texture_filter(const JsonNode& node) {
    const auto filter = node.find("filter");
    if (!filter) return MapFilter::none;
    const std::string name = filter->as_string();
    return filter->with_place([&] { return parse_texture_filter(name); });
}

/// `node`: a file name, or an object with it. `is_own_key`: that of the texture alone.
InputTexture read_input_texture(const JsonNode& node, const MaterialInputKind& kind, bool is_own_key,
                                AssetCache& assets) {
    InputTexture texture;
    texture.input = kind.input;
    const bool is_object = !node.is_string();
    if (is_object) check_texture_keys(node, kind, is_own_key);
    const JsonNode file = is_object ? node.get("file") : node;
    const std::string name = is_object ? read_picture_file(node, assets) : file.as_string();
    texture.is_udim = has_tile_token(name);
    TextureUse use = kind.is_color() ? TextureUse::color : TextureUse::number;
    if (kind.input == MaterialInput::normal) use = TextureUse::vector;
    uint32_t channel = 0;
    std::string space;
    if (is_object) {
        texture.filter = read_texture_filter(node);
        if (const auto found = node.find("channel")) channel = read_channel(*found), use = TextureUse::number;
        space = read_color_space(node);
        read_place(node, texture);
    }
    texture.tiles = file.with_place([&] { return assets.load_tiles(name, use, channel, space); });
    return texture;
}

/// Reads the texture of one input if the material has it: as an object under the name of the input, or under
/// the key for its texture.
void read_one(const JsonNode& node, const MaterialInputKind& kind, AssetCache& assets, Material& material) {
    for (const char* key : {kind.name, kind.alias}) {
        const auto found = key ? node.find(key) : std::nullopt;
        if (!found || !found->is_object() || kind.input == MaterialInput::normal) continue;
        if (kind.texture_key && node.find(kind.texture_key))
            found->fail(fmt::format("has a texture twice: '{}' is there too", kind.texture_key),
                        "leave one of the two out");
        material.textures.push_back(read_input_texture(*found, kind, false, assets));
        return;
    }
    if (!kind.texture_key) return;
    for (const char* key : {kind.texture_key, kind.input == MaterialInput::normal ? kind.name : nullptr}) {
        const auto found = key ? node.find(key) : std::nullopt;
        if (!found) continue;
        material.textures.push_back(read_input_texture(*found, kind, true, assets));
        return;
    }
}

} // namespace

void read_input_textures(const JsonNode& node, AssetCache& assets, Material& material) {
    for (const MaterialInputKind& kind : list_material_inputs()) read_one(node, kind, assets, material);
}

std::string read_picture_file(const JsonNode& node, AssetCache& assets) {
    const std::string file = node.get("file").as_string();
    const auto part = node.find("part"), layer = node.find("layer");
    if (!part && !layer) return file;
    const std::string names[] = {part ? part->as_string() : "", layer ? layer->as_string() : ""};
    const PictureName named = split_picture_name(file);
    if (!named.part.empty() || !named.layer.empty())
        (layer ? layer : part)->fail("the file's name has a layer already", "name it once");
    return assets.name_layer(file, names[0], names[1]);
}

std::string read_color_space(const JsonNode& node) {
    const auto space = node.find("color_space");
    if (!space) return {};
    const std::string name = space->as_string();
    if (name.empty()) space->fail("a colour space needs a name", "auto, linear, srgb, acescg, ...");
    return name == "auto" ? std::string() : name;
}

} // namespace relief
