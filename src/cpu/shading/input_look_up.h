// Textures of a material's inputs at one point.
#pragma once

#include "cpu/shading/texture_place.h"

namespace relief::cpu {

/// The numbers at a place, each in its range. `numbers`: those before the textures.
scalar::InputNumbers find_inputs(const TexturedMaterial& material, const scalar::InputNumbers& numbers,
                                 const TexturePlace& place);

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
