// Textures of a material's inputs at one point.
#pragma once

#include <optional>
#include <span>

#include "cpu/shading/texture_place.h"

namespace relief::cpu {

/// Returns the place on the uv plane at which a texture is read. A UDIM texture selects its tile by it.
Vec2f find_texture_uv(const PlacedTexture& texture, const TexturePlace& place);

/// Returns the value of a texture at a place of find_texture_uv, or nothing where its tile is missing.
std::optional<Vec3f> fetch_placed(const PlacedTexture& texture, const Vec2f& uv);

/// Multiplies `numbers` by the textures that `places` selects, a set of bits as scalar::kPointPlaces. Each
/// result is limited to its range.
scalar::InputNumbers find_inputs(std::span<const PlacedTexture> textures, uint32_t places,
                                 const scalar::InputNumbers& numbers, const TexturePlace& place);

/// Radiance that a material of the scene emits.
Vec3f find_emission(const PreparedScene& scene, uint32_t material, const TexturePlace& place);

/// Of a material of the scene, in [0, 1].
struct WallNumbers {
    float opacity;
    float metallic;                ///< this and
    scalar::GlassParameters glass; ///< this of glass alone
};
WallNumbers find_wall_numbers(const PreparedScene& scene, uint32_t material, const TexturePlace& place);

/// Of a material with a normal map.
Vec3f find_normal_texel(const PreparedScene& scene, uint32_t material, const TexturePlace& place);

} // namespace relief::cpu
