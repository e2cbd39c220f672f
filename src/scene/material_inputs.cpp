#include "scene/material_inputs.h"

#include <algorithm>

#include "image/texel_layout.h"

namespace relief {

namespace {

using enum MaterialInput;

constexpr std::array<MaterialInputKind, kMaterialInputCount> kKinds{{
    {base_color, "base_color", nullptr, nullptr, &Material::base_color, "base_color_texture"},
    {base_weight, "base_weight", nullptr, &Material::base_weight},
    {base_diffuse_roughness, "base_diffuse_roughness", nullptr, &Material::base_diffuse_roughness, nullptr,
     nullptr, true},
    {metallic, "base_metalness", "metallic", &Material::metallic, nullptr, "metallic_texture"},
    {roughness, "specular_roughness", "roughness", &Material::roughness, nullptr, "roughness_texture", true},
    {specular_weight, "specular_weight", nullptr, &Material::specular_weight, nullptr, nullptr, true},
    {specular_color, "specular_color", nullptr, nullptr, &Material::specular_color},
    {coat_weight, "coat_weight", nullptr, &Material::coat_weight, nullptr, nullptr, true},
    {coat_color, "coat_color", nullptr, nullptr, &Material::coat_color},
    {coat_roughness, "coat_roughness", nullptr, &Material::coat_roughness, nullptr, nullptr, true},
    {coat_darkening, "coat_darkening", nullptr, &Material::coat_darkening},
    {fuzz_weight, "fuzz_weight", nullptr, &Material::fuzz_weight, nullptr, nullptr, true},
    {fuzz_color, "fuzz_color", nullptr, nullptr, &Material::fuzz_color},
    {fuzz_roughness, "fuzz_roughness", nullptr, &Material::fuzz_roughness, nullptr, nullptr, true},
    {transmission_weight, "transmission_weight", nullptr, &Material::transmission_weight},
    {transmission_color, "transmission_color", nullptr, nullptr, &Material::transmission_color},
    {emission, "emission_color", "emission", nullptr, &Material::emission},
    {emission_luminance, "emission_luminance", nullptr, nullptr, &Material::emission},
    {opacity, "geometry_opacity", "opacity", &Material::opacity, nullptr, "opacity_texture"},
    {normal, "geometry_normal", "normal_texture", nullptr, nullptr, "normal_texture"},
}};

constexpr bool is_in_order() {
    for (size_t k = 0; k < kKinds.size(); ++k)
        if (kKinds[k].input != MaterialInput(k)) return false;
    return true;
}
static_assert(is_in_order());

} // namespace

std::span<const MaterialInputKind, kMaterialInputCount> list_material_inputs() { return kKinds; }

const char* get_input_name(MaterialInput input) { return get_input_kind(input).name; }

const InputTexture* find_input_texture(const Material& material, MaterialInput input) {
    const auto found = std::ranges::find(material.textures, input, &InputTexture::input);
    return found == material.textures.end() ? nullptr : &*found;
}

FactorRange find_factors(const InputTexture& texture) {
    FactorRange range{1e30f, -1e30f};
    const auto add = [&](float value) {
        range.lower = std::min(range.lower, value), range.upper = std::max(range.upper, value);
    };
    for (const MapTile& tile : texture.tiles) {
        const Texture& texels = *tile.texture;
        for (size_t k = 0; k < size_t(texels.width) * texels.height; ++k)
            add(load_value(texels, k * texels.stride));
    }
    if (texture.is_udim) add(1); // where there is no tile
    if (texture.wrap == WrapMode::black) add(0);
    return range;
}

} // namespace relief
