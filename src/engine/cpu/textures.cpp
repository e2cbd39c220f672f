#include "engine/cpu/textures.h"

#include <algorithm>
#include <cmath>

#include "math/half.h"
#include "math/vec.h"

namespace relief::cpu {

namespace {

Vec3f blend(const Vec3f& a, const Vec3f& b, float s) { return a * (1 - s) + b * s; }

uint32_t wrap(int64_t i, uint32_t size) {
    const int64_t rest = i % int64_t(size);
    return uint32_t(rest < 0 ? rest + int64_t(size) : rest);
}

uint32_t clamp_index(int64_t i, uint32_t size) {
    return uint32_t(std::clamp<int64_t>(i, 0, int64_t(size) - 1));
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
    const float x = (uv.x - std::floor(uv.x)) * float(texture.width) - 0.5f;
    const float y = (1.0f - (uv.y - std::floor(uv.y))) * float(texture.height) - 0.5f;
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    const uint32_t x0 = wrap(int64_t(std::floor(x)), texture.width),
                   x1 = wrap(int64_t(x0) + 1, texture.width);
    const uint32_t y0 = wrap(int64_t(std::floor(y)), texture.height),
                   y1 = wrap(int64_t(y0) + 1, texture.height);
    return blend(blend(fetch_texel(texture, x0, y0), fetch_texel(texture, x1, y0), fx),
                 blend(fetch_texel(texture, x0, y1), fetch_texel(texture, x1, y1), fx), fy);
}

Vec3f fetch_latlong(const Texture& texture, const Vec2f& position) {
    const float x = position.x * float(texture.width) - 0.5f;
    const float y = position.y * float(texture.height) - 0.5f;
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    const int64_t row = int64_t(std::floor(y));
    const uint32_t x0 = wrap(int64_t(std::floor(x)), texture.width),
                   x1 = wrap(int64_t(x0) + 1, texture.width);
    const uint32_t y0 = clamp_index(row, texture.height), y1 = clamp_index(row + 1, texture.height);
    return blend(blend(fetch_texel(texture, x0, y0), fetch_texel(texture, x1, y0), fx),
                 blend(fetch_texel(texture, x0, y1), fetch_texel(texture, x1, y1), fx), fy);
}

} // namespace relief::cpu
