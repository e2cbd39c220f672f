// Look-ups of colour textures and environments: bilinear on the raw texels, or by a B-spline.
#ifndef RELIEF_TEXTURES_GLSL
#define RELIEF_TEXTURES_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/environment.h"
#include "formulas/texture.h"

/// Bilinear value at a position in texels from the centre of texel (0, 0); repeated in x.
vec3 fetch_bilinear(const TextureData source, const vec2 at, const uint wrap_y) {
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
vec3 fetch_spline_color(const TextureData source, const vec2 at) {
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
vec3 fetch_texture(const uint index, const vec2 uv) {
    TextureData source = textures[index & ~kSplineTexture];
    if (!is_finite(vec3(uv, 0.0))) return make_texture_color(source.channel_count, load_texel(source, 0u, 0u).xyz);
    vec2 at = locate_texture_uv(uv, vec2(source.width, source.height));
    if (kHasSmooth != 0 && (index & kSplineTexture) != 0u) return fetch_spline_color(source, at);
    return fetch_bilinear(source, at, kWrapRepeat);
}

/// A texel, or 0 outside with kWrapBlack.
vec3 load_wrapped(const TextureData source, const int x, const int y, const uint wrap) {
    int column = wrap_texel(x, int(source.width), wrap);
    int row = wrap_texel(y, int(source.height), wrap);
    return column < 0 || row < 0 ? vec3(0.0) : load_texel(source, uint(column), uint(row)).xyz;
}

vec3 blend_texels(const vec3 a, const vec3 b, const float f) {
    return vec3(blend(a.x, b.x, f), blend(a.y, b.y, f), blend(a.z, b.z, f));
}

/// As fetch_texture, by any way to go on outside [0, 1]^2.
vec3 fetch_wrapped(const uint index, const vec2 uv, const uint wrap) {
    TextureData source = textures[index & ~kSplineTexture];
    if (!is_finite(vec3(uv, 0.0))) return make_texture_color(source.channel_count, load_texel(source, 0u, 0u).xyz);
    vec2 size = vec2(source.width, source.height);
    vec2 at = wrap == kWrapRepeat ? locate_texture_uv(uv, size) : locate_wrapped_uv(uv, size);
    ivec2 whole = ivec2(floor_texel(at.x), floor_texel(at.y));
    vec2 f = at - vec2(whole);
    bool is_spline = kHasSmooth != 0 && (index & kSplineTexture) != 0u;
    int first = is_spline ? -1 : 0;
    int count = is_spline ? 4 : 2;
    vec3 row[4];
    for (int j = 0; j < count; ++j) {
        vec3 texel[4];
        for (int i = 0; i < count; ++i)
            texel[i] = load_wrapped(source, whole.x + first + i, whole.y + first + j, wrap);
        if (is_spline)
            row[j] = blend_cubic_vectors(texel[0], texel[1], texel[2], texel[3], weigh_spline(f.x));
        else
            row[j] = blend_texels(texel[0], texel[1], f.x);
    }
    vec3 value = is_spline ? blend_cubic_vectors(row[0], row[1], row[2], row[3], weigh_spline(f.y))
                           : blend_texels(row[0], row[1], f.y);
    return make_texture_color(source.channel_count, value);
}

/// Value at a position in [0, 1]^2 from the top left corner: repeated in x, clamped in y.
vec3 fetch_latlong(const uint index, const vec2 position) {
    TextureData source = textures[index];
    return fetch_bilinear(source, locate_latlong(position, vec2(source.width, source.height)), kWrapClamp);
}

#endif
