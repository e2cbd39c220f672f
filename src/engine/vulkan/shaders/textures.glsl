// Look-ups of colour textures and environments: bilinear, on the raw texels.
#ifndef RELIEF_TEXTURES_GLSL
#define RELIEF_TEXTURES_GLSL

#include "engine/vulkan/shaders/scene.glsl"
#include "shared/texture.h"

/// Bilinear value at a place in texels from the centre of texel (0, 0); repeated in x.
vec3 fetch_bilinear(TextureData source, vec2 at, uint wrap_y) {
    vec2 whole = vec2(floor_texel(at.x), floor_texel(at.y));
    vec2 fraction = at - whole;
    int width = int(source.width);
    int height = int(source.height);
    uint left = uint(wrap_texel(int(whole.x), width, kWrapRepeat));
    uint right = uint(wrap_texel(int(whole.x) + 1, width, kWrapRepeat));
    uint top = uint(wrap_texel(int(whole.y), height, wrap_y));
    uint bottom = uint(wrap_texel(int(whole.y) + 1, height, wrap_y));
    vec4 upper = mix(load_texel(source, left, top), load_texel(source, right, top), fraction.x);
    vec4 lower = mix(load_texel(source, left, bottom), load_texel(source, right, bottom), fraction.x);
    return make_texture_color(source.channel_count, mix(upper, lower, fraction.y).xyz);
}

/// Repeated in both directions; row 0 is v = 1. A uv that is not finite gives texel (0, 0).
vec3 fetch_texture(uint index, vec2 uv) {
    TextureData source = textures[index];
    if (!is_finite(vec3(uv, 0.0))) return make_texture_color(source.channel_count, load_texel(source, 0u, 0u).xyz);
    return fetch_bilinear(source, locate_texture_uv(uv, vec2(source.width, source.height)), kWrapRepeat);
}

/// Value at a position in [0, 1]^2 from the top left corner: repeated in x, clamped in y.
vec3 fetch_latlong(uint index, vec2 position) {
    TextureData source = textures[index];
    return fetch_bilinear(source, locate_latlong(position, vec2(source.width, source.height)), kWrapClamp);
}

#endif
