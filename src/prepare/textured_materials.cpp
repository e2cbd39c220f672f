#include "prepare/textured_materials.h"

#include "base/check.h"
#include "scene/material_inputs.h"

namespace relief {

namespace {

scalar::InputNumbers list_numbers(const Material& material) {
    scalar::InputNumbers numbers{};
    for (const MaterialInputKind& kind : list_material_inputs()) {
        const InputPlace place = find_input_place(kind.input);
        if (kind.color)
            for (uint32_t c = 0; c < 3; ++c)
                numbers.word[place.first + c] = get_component(material.*kind.color, int(c));
        else if (kind.number && place.count == 1)
            numbers.word[place.first] = material.*kind.number;
    }
    const Vec3f up{0.5f, 0.5f, 1}; // where its map has no tile
    for (uint32_t c = 0; c < 3; ++c) numbers.word[scalar::kInputNormal + c] = get_component(up, int(c));
    return numbers;
}

PlacedTexture place_texture(const InputTexture& texture) {
    PlacedTexture placed{.place = find_input_place(texture.input),
                         .tiles = {},
                         .is_number = texture.input == MaterialInput::base_weight ||
                                      texture.input == MaterialInput::emission_luminance,
                         .is_udim = texture.is_udim,
                         .is_smooth = is_smooth(texture.filter),
                         .wrap = texture.is_udim ? WrapMode::clamp : texture.wrap,
                         .uv_scale = texture.uv_scale,
                         .uv_offset = texture.uv_offset,
                         .uv_set = texture.uv_set};
    for (const MapTile& tile : texture.tiles) {
        const size_t index = texture.is_udim ? size_t(tile.udim - 1001) : 0;
        if (placed.tiles.size() <= index) placed.tiles.resize(index + 1);
        placed.tiles[index] = tile.texture;
    }
    return placed;
}

/// Whether it changes base colour, roughness or metallic by itself.
bool is_of_point(MaterialInput input) {
    return input == MaterialInput::base_color || input == MaterialInput::roughness ||
           input == MaterialInput::metallic;
}

TexturedMaterial make_textured_material(const Material& material) {
    TexturedMaterial textured;
    textured.numbers = list_numbers(material);
    textured.constants = {material.ior, material.coat_ior,
                          material.transmission_depth > 0 && !material.is_thin_walled ? 1u : 0u};
    for (const bool is_first : {true, false})
        for (const InputTexture& texture : material.textures) {
            if (is_of_point(texture.input) != is_first) continue;
            textured.textures.push_back(place_texture(texture));
            textured.places |= 1u << textured.textures.back().place.first;
            if (is_first)
                ++textured.point_count;
            else if (texture.input != MaterialInput::opacity && texture.input != MaterialInput::normal)
                textured.has_vertex_numbers = true;
        }
    return textured;
}

} // namespace

InputPlace find_input_place(MaterialInput input) {
    switch (input) {
    case MaterialInput::base_color:
        return {scalar::kInputBaseColor, 3};
    case MaterialInput::base_weight:
        return {scalar::kInputBaseColor, 3};
    case MaterialInput::base_diffuse_roughness:
        return {scalar::kInputDiffuseRoughness, 1};
    case MaterialInput::metallic:
        return {scalar::kInputMetallic, 1};
    case MaterialInput::roughness:
        return {scalar::kInputRoughness, 1};
    case MaterialInput::specular_weight:
        return {scalar::kInputSpecularWeight, 1};
    case MaterialInput::specular_color:
        return {scalar::kInputSpecularColor, 3};
    case MaterialInput::coat_weight:
        return {scalar::kInputCoatWeight, 1};
    case MaterialInput::coat_color:
        return {scalar::kInputCoatColor, 3};
    case MaterialInput::coat_roughness:
        return {scalar::kInputCoatRoughness, 1};
    case MaterialInput::coat_darkening:
        return {scalar::kInputCoatDarkening, 1};
    case MaterialInput::fuzz_weight:
        return {scalar::kInputFuzzWeight, 1};
    case MaterialInput::fuzz_color:
        return {scalar::kInputFuzzColor, 3};
    case MaterialInput::fuzz_roughness:
        return {scalar::kInputFuzzRoughness, 1};
    case MaterialInput::transmission_weight:
        return {scalar::kInputTransmissionWeight, 1};
    case MaterialInput::transmission_color:
        return {scalar::kInputTransmissionColor, 3};
    case MaterialInput::emission:
        return {scalar::kInputEmission, 3};
    case MaterialInput::emission_luminance:
        return {scalar::kInputEmission, 3};
    case MaterialInput::opacity:
        return {scalar::kInputOpacity, 1};
    case MaterialInput::normal:
        return {scalar::kInputNormal, 3};
    }
    DCHECK(false);
    return {};
}

TexturedMaterials make_textured_materials(const std::vector<Material>& materials) {
    TexturedMaterials result;
    for (const Material& material : materials) {
        const bool has_textures = !material.textures.empty();
        result.of_material.push_back(has_textures ? uint32_t(result.list.size()) : kNoIndex);
        if (!has_textures) continue;
        result.list.push_back(make_textured_material(material));
        result.has_vertex_numbers |= result.list.back().has_vertex_numbers;
    }
    return result;
}

} // namespace relief
