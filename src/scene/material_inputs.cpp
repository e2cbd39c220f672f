#include "scene/material_inputs.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/udim.h"
#include "image/texel_layout.h"

namespace relief {

namespace {

using enum MaterialInput;

constexpr const char* kNoAnisotropyTexture = "give it as a number; the roughness itself may have a texture";

/// The key of a texture counts as a key of its input. Rows are in the order of docs/formats.md.
constexpr MaterialInputKind kFields[] = {
    {.name = "base_weight",
     .number = &Material::base_weight,
     .input = base_weight,
     .meaning = "Multiplies `base_color`."},
    {.name = "base_color",
     .color = &Material::base_color,
     .input = base_color,
     .texture_key = "base_color_texture",
     .is_always_saved = true,
     .meaning = "Reflectance of the diffuse base; for a metal, reflectance at normal incidence."},
    {.name = "base_diffuse_roughness",
     .number = &Material::base_diffuse_roughness,
     .input = base_diffuse_roughness,
     .is_layered = true,
     .meaning = "Roughness of the diffuse base: 0 is Lambert's law, 1 looks flat like the moon."},
    {.name = "base_metalness",
     .alias = "metallic",
     .number = &Material::metallic,
     .input = metallic,
     .texture_key = "metallic_texture",
     .is_always_saved = true,
     .meaning = "Mixes a dielectric (0) with a metal (1)."},
    {.name = "specular_weight",
     .number = &Material::specular_weight,
     .input = specular_weight,
     .is_layered = true,
     .meaning = "Multiplies the reflection of the base at normal incidence."},
    {.name = "specular_color",
     .color = &Material::specular_color,
     .input = specular_color,
     .meaning = "Multiplies the reflection of a dielectric; tints a metal towards grazing angles."},
    {.name = "specular_roughness",
     .alias = "roughness",
     .number = &Material::roughness,
     .input = roughness,
     .texture_key = "roughness_texture",
     .is_layered = true,
     .is_always_saved = true,
     .meaning = "Roughness of the clear surface, of a metal and of glass. The alpha of GGX is its square."},
    {.name = "specular_roughness_anisotropy",
     .number = &Material::specular_roughness_anisotropy,
     .texture_hint = kNoAnisotropyTexture,
     .meaning =
         "Makes the base and glass rougher along u than along v, as if brushed along v: highlights become "
         "streaks along u. The mesh needs uvs."},
    {.name = "specular_ior",
     .alias = "ior",
     .number = &Material::ior,
     .low = 1,
     .high = kUnboundedInput,
     .texture_hint = "texture specular_weight, which scales the same reflection",
     .is_always_saved = true,
     .meaning = "Index of refraction of the dielectric; 1 removes its clear surface."},
    {.name = "coat_weight",
     .number = &Material::coat_weight,
     .input = coat_weight,
     .is_layered = true,
     .meaning = "Part of the surface that lies under a clear coat."},
    {.name = "coat_color",
     .color = &Material::coat_color,
     .input = coat_color,
     .meaning =
         "Part of the light that the coat leaves after a way straight down and up again; slanted ways lose "
         "more."},
    {.name = "coat_roughness",
     .number = &Material::coat_roughness,
     .input = coat_roughness,
     .is_layered = true,
     .meaning = "Roughness of the coat, which blurs the base as well."},
    {.name = "coat_roughness_anisotropy",
     .number = &Material::coat_roughness_anisotropy,
     .texture_hint = kNoAnisotropyTexture,
     .meaning = "Makes the coat rougher along u than along v. The mesh needs uvs."},
    {.name = "coat_ior",
     .number = &Material::coat_ior,
     .low = 1,
     .high = kUnboundedInput,
     .texture_hint = "texture coat_weight, which scales the same reflection",
     .meaning = "Index of refraction of the coat."},
    {.name = "coat_darkening",
     .number = &Material::coat_darkening,
     .input = coat_darkening,
     .meaning = "Darkens the base by the light that the coat reflects back onto it."},
    {.name = "fuzz_weight",
     .number = &Material::fuzz_weight,
     .input = fuzz_weight,
     .is_layered = true,
     .meaning = "Part of the surface that lies under fuzz, such as dust or velvet."},
    {.name = "fuzz_color",
     .color = &Material::fuzz_color,
     .input = fuzz_color,
     .meaning = "Colour of the fuzz."},
    {.name = "fuzz_roughness",
     .number = &Material::fuzz_roughness,
     .input = fuzz_roughness,
     .is_layered = true,
     .meaning = "Spreads the fuzz from a thin rim (0) to the whole surface (1)."},
    {.name = "transmission_weight",
     .number = &Material::transmission_weight,
     .input = transmission_weight,
     .meaning =
         "Part of the dielectric that is glass, with `ior` and `roughness` of the base (0 is smooth). It "
         "excludes `coat_weight` and `fuzz_weight`."},
    {.name = "transmission_color",
     .color = &Material::transmission_color,
     .input = transmission_color,
     .meaning =
         "Part of the light that is left after `transmission_depth` within the body; without a depth, after "
         "each crossing of the surface; straight through a thin wall."},
    {.name = "transmission_depth",
     .number = &Material::transmission_depth,
     .high = kUnboundedInput,
     .texture_hint = "it is of the inside of a body, where there are no uvs",
     .unit = "scene units",
     .meaning = "Depth at which `transmission_color` is reached; with 0 the body itself absorbs nothing. A "
                "thin wall "
                "ignores it."},
    {.name = "geometry_thin_walled",
     .flag = &Material::is_thin_walled,
     .texture_hint = "give true or false",
     .meaning = "Makes glass a thin wall, which refracts nothing, instead of a body."},
    {.name = "emission_luminance",
     .color = &Material::emission,
     .high = kUnboundedInput,
     .input = emission_luminance,
     .meaning = "Multiplies `emission_color`; the product is the radiance that the surface emits."},
    {.name = "emission_color",
     .alias = "emission",
     .color = &Material::emission,
     .input = emission,
     .meaning = "Colour of the emission, in [0, 1], beside `emission_luminance`. `emission` is the radiance "
                "itself."},
    {.name = "geometry_opacity",
     .alias = "opacity",
     .number = &Material::opacity,
     .input = opacity,
     .texture_key = "opacity_texture",
     .meaning = "Part of the rays that the surface stops. Below 1, or with a texture, the surface is a "
                "cut-out, which "
                "rays hit or pass at random. A material that emits light cannot be one."},
    {.name = "geometry_normal",
     .alias = "normal_texture",
     .input = normal,
     .texture_key = "normal_texture",
     .meaning = "Tangent-space normal map, read without a change: a direction is 2 value - 1 of red, green "
                "and blue."},
};

constexpr std::array<MaterialInputKind, kMaterialInputCount> select_textured() {
    std::array<MaterialInputKind, kMaterialInputCount> rows{};
    for (const MaterialInputKind& field : kFields)
        if (field.input != kUntextured) rows[size_t(field.input)] = field;
    return rows;
}

constexpr auto kKinds = select_textured();

constexpr bool has_all_inputs() {
    for (size_t k = 0; k < kKinds.size(); ++k)
        if (!kKinds[k].name || kKinds[k].input != MaterialInput(k)) return false;
    return true;
}
static_assert(has_all_inputs());

std::vector<std::string_view> make_keys() {
    std::vector<std::string_view> keys{"light_group"};
    const auto add = [&](const char* key) {
        if (key && std::ranges::find(keys, key) == keys.end()) keys.emplace_back(key);
    };
    for (const MaterialInputKind& field : kFields) add(field.name), add(field.alias), add(field.texture_key);
    return keys;
}

} // namespace

std::span<const MaterialInputKind> list_material_fields() { return kFields; }

std::span<const MaterialInputKind, kMaterialInputCount> list_material_inputs() { return kKinds; }

std::span<const std::string_view> list_material_keys() {
    static const std::vector<std::string_view> keys = make_keys();
    return keys;
}

const char* get_input_name(MaterialInput input) { return get_input_kind(input).name; }

const InputTexture* find_input_texture(const Material& material, MaterialInput input) {
    const auto found = std::ranges::find(material.textures, input, &InputTexture::input);
    return found == material.textures.end() ? nullptr : &*found;
}

void set_input_texture(Material& material, MaterialInput input, std::shared_ptr<const Texture> texture,
                       MapFilter filter) {
    std::erase_if(material.textures, [&](const InputTexture& other) { return other.input == input; });
    if (!texture) return;
    InputTexture& added = material.textures.emplace_back();
    added.input = input, added.filter = filter;
    added.tiles.push_back({kFirstUdim, std::move(texture)});
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
