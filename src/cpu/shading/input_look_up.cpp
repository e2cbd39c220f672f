#include "cpu/shading/input_look_up.h"

#include <optional>

#include "cpu/shading/point_material.h"
#include "cpu/shading/textures.h"
#include "formulas/texture.h"

namespace relief::cpu {

namespace {

/// Nothing where a tile lacks.
std::optional<Vec3f> fetch_placed(const PlacedTexture& texture, const TexturePlace& place) {
    const Vec2f uv = place.find_uv(texture.uv_set);
    Vec2f at{uv.x * texture.uv_scale.x + texture.uv_offset.x,
             uv.y * texture.uv_scale.y + texture.uv_offset.y};
    uint32_t tile = 0;
    if (texture.is_udim) {
        const Vec2f corner{scalar::floor_texel(at.x), scalar::floor_texel(at.y)};
        tile = scalar::find_udim(corner.x, corner.y);
        if (tile >= texture.tiles.size() || !texture.tiles[tile]) return std::nullopt;
        at = at - corner;
    }
    const MapFilter filter = texture.is_smooth ? MapFilter::bspline : MapFilter::none;
    const Vec3f value = texture.wrap == WrapMode::repeat
                            ? fetch_texture(*texture.tiles[tile], filter, at)
                            : fetch_wrapped(*texture.tiles[tile], filter, texture.wrap, at);
    return texture.is_number ? Vec3f{value.x, value.x, value.x} : value;
}

} // namespace

scalar::InputNumbers find_inputs(const TexturedMaterial& material, const scalar::InputNumbers& numbers,
                                 const TexturePlace& place) {
    scalar::InputNumbers result = numbers;
    for (const PlacedTexture& texture : material.textures)
        if (const std::optional<Vec3f> value = fetch_placed(texture, place))
            result = scalar::apply_input(result, texture.place.first, texture.place.count, *value);
    return scalar::limit_inputs(result);
}

Vec3f find_emission(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const TexturedMaterial* textured = scene.textured.find(material);
    if (!textured) return scene.materials[material].emission;
    return scalar::get_input_color(find_inputs(*textured, textured->numbers, place), scalar::kInputEmission);
}

WallNumbers find_wall_numbers(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const Material& numbers = scene.materials[material];
    const scalar::GlassParameters* glass = scene.glass.find(material);
    WallNumbers result{find_opacity(numbers, place.uv), 0, {}};
    if (glass) result.metallic = find_metallic(numbers, place.uv), result.glass = *glass;
    const TexturedMaterial* textured = scene.textured.find(material);
    if (!textured) return result;
    scalar::InputNumbers start = textured->numbers;
    start.word[scalar::kInputOpacity] = result.opacity, start.word[scalar::kInputMetallic] = result.metallic;
    const scalar::InputNumbers found = find_inputs(*textured, start, place);
    result.opacity = found.word[scalar::kInputOpacity], result.metallic = found.word[scalar::kInputMetallic];
    if (glass) result.glass = scalar::set_glass_inputs(*glass, found, textured->constants);
    return result;
}

Vec3f find_normal_texel(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const Material& numbers = scene.materials[material];
    if (numbers.normal_texture)
        return fetch_texture(*numbers.normal_texture, numbers.normal_filter, place.uv);
    const TexturedMaterial* textured = scene.textured.find(material);
    return scalar::get_input_color(find_inputs(*textured, textured->numbers, place), scalar::kInputNormal);
}

} // namespace relief::cpu
