// Textures of the inputs of materials: cpu/shading/input_look_up.cpp. What they make of the numbers at a
// vertex lies behind the surface points, unless kHasVertexNumbers is 0.
#ifndef RELIEF_INPUT_LOOK_UP_GLSL
#define RELIEF_INPUT_LOOK_UP_GLSL

#include "vulkan/shaders/ggx_table.glsl"
#include "vulkan/shaders/textures.glsl"
#include "vulkan/shaders/texture_place.glsl"

layout(scalar, set = 0, binding = kBindMaterials) readonly buffer MaterialInputs { MaterialInputData material_inputs[]; };
layout(scalar, set = 0, binding = kBindMaterials) readonly buffer InputTextures { InputTextureData input_textures[]; };
layout(scalar, set = 0, binding = kBindMaterials) readonly buffer InputTiles { uint input_tiles[]; };

layout(constant_id = kPlacedTexturesConstant) const uint kHasPlacedTextures = 0;

/// The value of a texture at a place on the uv plane; false where a tile lacks.
bool fetch_placed(const InputTextureData source, vec2 at, out vec3 value) {
    uint tile = 0u;
    if (kHasPlacedTextures != 0u && source.is_udim != 0u) {
        vec2 corner = vec2(floor_texel(at.x), floor_texel(at.y));
        tile = find_udim(corner.x, corner.y);
        at -= corner;
        if (tile >= source.tile_count) return false;
    }
    uint index = input_tiles[source.first_tile + tile];
    if (kHasPlacedTextures != 0u && index == kNone) return false;
    // Loops over the texels of a spline leave registers for the numbers of a vertex.
    bool has_loops = kHasPlacedTextures != 0u || (kHasVertexNumbers != 0u && kHasSmooth != 0u);
    value = has_loops ? fetch_wrapped(index, at, source.wrap) : fetch_texture(index, at);
    return true;
}

/// As apply_input, of the numbers that points have of themselves. No index is computed, so that they stay in
/// registers.
InputNumbers apply_point_input(InputNumbers numbers, const uint place, const vec3 value) {
    if (place == kInputBaseColor) return apply_input(numbers, kInputBaseColor, 3u, value);
    if (place == kInputRoughness) return apply_input(numbers, kInputRoughness, 1u, value);
    if (place == kInputMetallic) return apply_input(numbers, kInputMetallic, 1u, value);
    if (place == kInputOpacity) return apply_input(numbers, kInputOpacity, 1u, value);
    return apply_input(numbers, kInputNormal, 3u, value);
}

/// What the textures of `places` make of the numbers.
InputNumbers find_inputs(const MaterialInputData inputs, const uint places, const TexturePlace place) {
    InputNumbers numbers = inputs.numbers;
    // A loop, so that the look-up is inlined only once.
    for (uint k = 0u; k < inputs.texture_count; ++k) {
        InputTextureData source = input_textures[inputs.first_texture + k];
        if (!has_place(places, source.place)) continue;
        vec3 value;
        vec2 at = find_uv(place, source.uv_set) * source.uv_scale + source.uv_offset;
        if (!fetch_placed(source, at, value)) continue;
        if (source.is_number != 0u) value = value.xxx;
        if (kHasVertexNumbers != 0u)
            numbers = apply_input(numbers, source.place, source.count, value);
        else
            numbers = apply_point_input(numbers, source.place, value);
    }
    return numbers;
}

/// `at`: on the patch of an instance.
InputNumbers find_inputs_at(const MaterialInputData inputs, const uint places, const InstanceData instance,
                            const uint patch_index, const vec2 at) {
    SurfaceData s = surfaces[instance.surface];
    vec2 uv = interpolate_uv(s, load_quad(s, patch_index), at);
    return find_inputs(inputs, places, TexturePlace(instance.surface, patch_index, at, uv));
}

#endif
