// Textures of the inputs of materials: cpu/shading/input_look_up.cpp. What they make of the numbers at a
// vertex lies behind the surface points. Nothing is left of all this where kHasInputTextures is 0.
#ifndef RELIEF_INPUT_LOOK_UP_GLSL
#define RELIEF_INPUT_LOOK_UP_GLSL

#include "vulkan/shaders/ggx_table.glsl"
#include "vulkan/shaders/textures.glsl"
#include "vulkan/shaders/texture_place.glsl"

layout(scalar, set = 0, binding = kBindMaterials) readonly buffer MaterialInputs { MaterialInputData material_inputs[]; };
layout(scalar, set = 0, binding = kBindMaterials) readonly buffer InputTextures { InputTextureData input_textures[]; };
layout(scalar, set = 0, binding = kBindMaterials) readonly buffer InputTiles { uint input_tiles[]; };

bool has_input_textures(const MaterialData material) { return kHasInputTextures != 0u && material.inputs != kNone; }

/// `numbers`: those before the textures.
InputNumbers find_inputs(const MaterialInputData inputs, InputNumbers numbers, const TexturePlace place) {
    // A loop, so that the look-up is inlined only once.
    for (uint k = 0u; k < inputs.texture_count; ++k) {
        InputTextureData source = input_textures[inputs.first_texture + k];
        vec2 at = find_uv(place, source.uv_set) * source.uv_scale + source.uv_offset;
        uint tile = 0u;
        if (source.is_udim != 0u) {
            vec2 corner = vec2(floor_texel(at.x), floor_texel(at.y));
            tile = find_udim(corner.x, corner.y);
            at -= corner;
        }
        if (tile >= source.tile_count) continue;
        uint index = input_tiles[source.first_tile + tile];
        if (index == kNone) continue;
        vec3 value = fetch_wrapped(index, at, source.wrap);
        if (source.is_number != 0u) value = value.xxx;
        numbers = apply_input(numbers, source.place, source.count, value);
    }
    return limit_inputs(numbers);
}

/// `at`: on the patch of an instance.
InputNumbers find_inputs_at(const MaterialInputData inputs, const InstanceData instance, const uint patch_index,
                            const vec2 at) {
    SurfaceData s = surfaces[instance.surface];
    vec2 uv = interpolate_uv(s, load_quad(s, patch_index), at);
    return find_inputs(inputs, inputs.numbers, TexturePlace(instance.surface, patch_index, at, uv));
}

#endif
