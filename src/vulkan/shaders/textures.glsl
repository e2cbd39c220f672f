// Look-ups of colour textures and environments: bilinear on the raw texels, or by a B-spline.
#ifndef RELIEF_TEXTURES_GLSL
#define RELIEF_TEXTURES_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/environment.h"
#include "formulas/texture.h"

/// Bilinear value at a position in texels from the centre of texel (0, 0); repeated in x.
vec3 fetch_bilinear(TextureData source, vec2 at, uint wrap_y) {
    vec2 whole = vec2(floor_texel(at.x), floor_texel(at.y));
    vec2 fraction = at - whole;
    int width = int(source.width);
    int height = int(source.height);
    uint left = uint(wrap_texel(int(whole.x), width, kWrapRepeat));
    uint right = uint(wrap_texel(int(whole.x) + 1, width, kWrapRepeat));
    uint top = uint(wrap_texel(int(whole.y), height, wrap_y));
    uint bottom = uint(wrap_texel(int(whole.y) + 1, height, wrap_y));
    vec4 t00 = load_texel(source, left, top);
    vec4 t10 = load_texel(source, right, top);
    vec4 t01 = load_texel(source, left, bottom);
    vec4 t11 = load_texel(source, right, bottom);
    vec3 value = vec3(filter_texels(t00.x, t10.x, t01.x, t11.x, fraction.x, fraction.y),
                      filter_texels(t00.y, t10.y, t01.y, t11.y, fraction.x, fraction.y),
                      filter_texels(t00.z, t10.z, t01.z, t11.z, fraction.x, fraction.y));
    return make_texture_color(source.channel_count, value);
}

/// Value of a B-spline with the texels as coefficients; repeated in both directions.
vec3 fetch_spline_color(TextureData source, vec2 at) {
    vec2 whole = vec2(floor_texel(at.x), floor_texel(at.y));
    CubicWeights along = weigh_spline(at.x - whole.x);
    vec3 point[4];
    for (int j = 0; j < 4; ++j) {
        uint row = uint(wrap_texel(int(whole.y) + j - 1, int(source.height), kWrapRepeat));
        vec3 coefficient[4];
        for (int i = 0; i < 4; ++i) {
            uint column = uint(wrap_texel(int(whole.x) + i - 1, int(source.width), kWrapRepeat));
            coefficient[i] = load_texel(source, column, row).xyz;
        }
        point[j] = blend_cubic_vectors(coefficient[0], coefficient[1], coefficient[2], coefficient[3], along);
    }
    vec3 value = blend_cubic_vectors(point[0], point[1], point[2], point[3], weigh_spline(at.y - whole.y));
    return make_texture_color(source.channel_count, value);
}

/// Repeated in both directions; row 0 is v = 1. `index` may have kSplineTexture. A non-finite uv gives texel (0, 0).
vec3 fetch_texture(uint index, vec2 uv) {
    TextureData source = textures[index & ~kSplineTexture];
    if (!is_finite(vec3(uv, 0.0))) return make_texture_color(source.channel_count, load_texel(source, 0u, 0u).xyz);
    vec2 at = locate_texture_uv(uv, vec2(source.width, source.height));
    if (kHasSmooth != 0 && (index & kSplineTexture) != 0u) return fetch_spline_color(source, at);
    return fetch_bilinear(source, at, kWrapRepeat);
}

/// Value at a position in [0, 1]^2 from the top left corner: repeated in x, clamped in y.
vec3 fetch_latlong(uint index, vec2 position) {
    TextureData source = textures[index];
    return fetch_bilinear(source, locate_latlong(position, vec2(source.width, source.height)), kWrapClamp);
}

#endif
