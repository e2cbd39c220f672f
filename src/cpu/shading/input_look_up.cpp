#include "cpu/shading/input_look_up.h"

#include "cpu/shading/textures.h"
#include "formulas/texture.h"

namespace relief::cpu {

Vec2f find_texture_uv(const PlacedTexture& texture, const TexturePlace& place) {
    const Vec2f uv = place.find_uv(texture.uv_set);
    return {uv.x * texture.uv_scale.x + texture.uv_offset.x, uv.y * texture.uv_scale.y + texture.uv_offset.y};
}

std::optional<Vec3f> fetch_placed(const PlacedTexture& texture, const Vec2f& uv) {
    Vec2f at = uv;
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

scalar::InputNumbers find_inputs(std::span<const PlacedTexture> textures, uint32_t places,
                                 const scalar::InputNumbers& numbers, const TexturePlace& place) {
    scalar::InputNumbers result = numbers;
    for (const PlacedTexture& texture : textures) {
        if (!scalar::has_place(places, texture.place.first)) continue;
        if (const std::optional<Vec3f> value = fetch_placed(texture, find_texture_uv(texture, place)))
            result = scalar::apply_input(result, texture.place.first, texture.place.count, *value);
    }
    return result;
}

Vec3f find_emission(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const TexturedMaterial* textured = scene.textured.find(material);
    if (!textured || !(textured->places & scalar::kEmissionPlace)) return scene.materials[material].emission;
    return scalar::get_input_color(
        find_inputs(textured->textures, scalar::kEmissionPlace, textured->numbers, place),
        scalar::kInputEmission);
}

WallNumbers find_wall_numbers(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const Material& numbers = scene.materials[material];
    const scalar::GlassParameters* glass = scene.glass.find(material);
    WallNumbers result{numbers.opacity, numbers.metallic, {}};
    if (glass) result.glass = *glass;
    const TexturedMaterial* textured = scene.textured.find(material);
    const uint32_t places = glass ? scalar::kWallPlaces : scalar::kOpacityPlace;
    if (!textured || !(textured->places & places)) return result;
    const scalar::InputNumbers found = find_inputs(textured->textures, places, textured->numbers, place);
    result.opacity = found.word[scalar::kInputOpacity], result.metallic = found.word[scalar::kInputMetallic];
    if (glass && textured->has_vertex_numbers)
        result.glass = scalar::set_glass_inputs(*glass, found, textured->constants);
    return result;
}

Vec3f find_normal_texel(const PreparedScene& scene, uint32_t material, const TexturePlace& place) {
    const TexturedMaterial& textured = *scene.textured.find(material);
    return scalar::get_input_color(
        find_inputs(textured.textures, scalar::kNormalPlace, textured.numbers, place), scalar::kInputNormal);
}

} // namespace relief::cpu
