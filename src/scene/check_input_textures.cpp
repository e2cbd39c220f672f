#include "scene/check_input_textures.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/udim.h"
#include "relief/error.h"
#include "scene/material_inputs.h"

namespace relief {

namespace {

constexpr float kFarthestUv = 1e6f;

[[noreturn]] void refuse(const std::string& where, const std::string& message, const std::string& hint = {}) {
    throw Error(ErrorKind::bad_input, {message, where, hint});
}

bool has_finite_texels(const Texture& texture) {
    constexpr uint16_t kExponent = 0x7c00;
    return std::ranges::all_of(texture.floats, [](float value) { return std::isfinite(value); }) &&
           std::ranges::none_of(texture.halves,
                                [](uint16_t bits) { return (bits & kExponent) == kExponent; });
}

void check_tiles(const std::string& where, const InputTexture& texture) {
    if (texture.tiles.empty() || (!texture.is_udim && texture.tiles.size() > 1))
        refuse(where, fmt::format("has {} tiles", texture.tiles.size()), "one, unless is_udim is set");
    std::set<int> seen;
    for (const MapTile& tile : texture.tiles) {
        if (texture.is_udim && (tile.udim < kFirstUdim || tile.udim > kLastUdim))
            refuse(where, fmt::format("tile {} is not in [{}, {}]", tile.udim, kFirstUdim, kLastUdim));
        if (!seen.insert(tile.udim).second) refuse(where, fmt::format("tile {} is there twice", tile.udim));
        if (!tile.texture) refuse(where, fmt::format("tile {} has no texture", tile.udim));
        if (!has_finite_texels(*tile.texture))
            refuse(where, "a value of the texture is no finite number", "repair the texture");
        if (texture.input == MaterialInput::normal && tile.texture->channel_count < 3)
            refuse(where, fmt::format("has {} channels, and a normal has three", tile.texture->channel_count),
                   "export it as RGB; a height map is a displacement");
    }
}

void check_input_texture(const Material& material, const InputTexture& texture, const std::string& where) {
    if (uint32_t(texture.wrap) > uint32_t(WrapMode::black) || texture.filter == MapFilter::mip ||
        texture.filter > MapFilter::bspline)
        refuse(where, "its wrap or filter is none of those there are", "filters are none, cubic and bspline");
    for (const auto& [what, value] :
         {std::pair("uv_scale", texture.uv_scale), std::pair("uv_offset", texture.uv_offset)})
        for (const float number : {value.x, value.y})
            if (!(std::fabs(number) <= kFarthestUv))
                refuse(where,
                       fmt::format("{} is {}, not in [{}, {}]", what, number, -kFarthestUv, kFarthestUv));
    check_tiles(where, texture);
    if (texture.uv_set < kOwnUvSet || texture.uv_set > kMaxUvSet)
        refuse(where, fmt::format("uv_set is {}, not in [0, {}]", texture.uv_set, kMaxUvSet));
    if (texture.uv_set != kOwnUvSet && texture.input == MaterialInput::normal)
        refuse(where,
               "a normal map cannot have a uv_set: its directions go by the uvs that the mesh is read with",
               "name its set as uv_set of the mesh, and the other one as that of the other textures");
    if (texture.input == MaterialInput::specular_weight && material.transmission_weight > 0)
        refuse(where, "a texture would give a body of glass an ior that changes over its surface",
               "texture transmission_weight or specular_color, or make the number constant");
    if (texture.input == MaterialInput::transmission_color && material.transmission_depth > 0 &&
        !material.is_thin_walled)
        refuse(where,
               "a texture lies on the surface, and with transmission_depth this is the colour of the inside",
               "leave transmission_depth out, so that each crossing of the surface takes the colour");
}

} // namespace

void check_input_textures(const Material& material, const std::string& where) {
    size_t layered = 0;
    std::set<MaterialInput> seen;
    for (const InputTexture& texture : material.textures)
        if (size_t(texture.input) >= kMaterialInputCount)
            refuse(where, fmt::format("a texture is for input {}, which there is not", int(texture.input)));
    for (const InputTexture& texture : material.textures) {
        const std::string place = fmt::format("{}, {}", where, get_input_name(texture.input));
        if (!seen.insert(texture.input).second)
            refuse(place, "has a texture twice", "leave one of the two out");
        check_input_texture(material, texture, place);
        layered += get_input_kind(texture.input).is_layered ? 1 : 0;
    }
    const size_t most = is_anisotropic(material) ? kMaxStretchedTextures : kMaxLayerTextures;
    if (layered > most)
        refuse(where,
               fmt::format(
                   "{} of the numbers that the albedo of its layers depends on have textures, and at most "
                   "{} may{}",
                   layered, most, is_anisotropic(material) ? " beside an anisotropy" : ""),
               "make some of base_diffuse_roughness, specular_roughness, specular_weight, coat_weight, "
               "coat_roughness, fuzz_weight and fuzz_roughness constant");
}

} // namespace relief
