#include "engine/cpu/textures.h"

#include <cmath>

#include "math/half.h"
#include "math/vec.h"
#include "surface/texels.h"

namespace relief::cpu {

namespace {

Vec3f blend(const Vec3f& a, const Vec3f& b, float s) { return a * (1 - s) + b * s; }

/// Bilinear value at (x, y), in texels from the centre of texel (0, 0); repeated in x.
Vec3f fetch_bilinear(const Texture& texture, float x, float y, WrapMode wrap_y) {
    const float whole_x = floor_texel(x), whole_y = floor_texel(y);
    const float fx = x - whole_x, fy = y - whole_y;
    const auto column = [&](int64_t i) { return uint32_t(wrap_index(i, texture.width, WrapMode::repeat)); };
    const auto row = [&](int64_t i) { return uint32_t(wrap_index(i, texture.height, wrap_y)); };
    const uint32_t x0 = column(int64_t(whole_x)), x1 = column(int64_t(whole_x) + 1);
    const uint32_t y0 = row(int64_t(whole_y)), y1 = row(int64_t(whole_y) + 1);
    return blend(blend(fetch_texel(texture, x0, y0), fetch_texel(texture, x1, y0), fx),
                 blend(fetch_texel(texture, x0, y1), fetch_texel(texture, x1, y1), fx), fy);
}

} // namespace

Vec3f fetch_texel(const Texture& texture, uint32_t x, uint32_t y) {
    const size_t i = (size_t(y) * texture.width + x) * 4;
    const bool is_grey = texture.channel_count < 3;
    if (!texture.floats.empty()) {
        const float* f = texture.floats.data() + i;
        return is_grey ? Vec3f{f[0], f[0], f[0]} : Vec3f{f[0], f[1], f[2]};
    }
    const uint16_t* h = texture.halves.data() + i;
    const float first = half_to_float(h[0]);
    return is_grey ? Vec3f{first, first, first} : Vec3f{first, half_to_float(h[1]), half_to_float(h[2])};
}

Vec3f fetch_texture(const Texture& texture, const Vec2f& uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fetch_texel(texture, 0, 0);
    // The whole part goes first: far from zero a float would have no bits left for the position between
    // texels.
    const float x = (uv.x - floor_texel(uv.x)) * float(texture.width) - 0.5f;
    const float y = (1.0f - (uv.y - floor_texel(uv.y))) * float(texture.height) - 0.5f;
    return fetch_bilinear(texture, x, y, WrapMode::repeat);
}

Vec3f fetch_latlong(const Texture& texture, const Vec2f& position) {
    return fetch_bilinear(texture, position.x * float(texture.width) - 0.5f,
                          position.y * float(texture.height) - 0.5f, WrapMode::clamp);
}

} // namespace relief::cpu
