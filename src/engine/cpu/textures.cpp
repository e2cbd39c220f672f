#include "engine/cpu/textures.h"

#include <cmath>

#include "surface/texels.h"

namespace relief::cpu {

namespace {

Vec3f make_color(const Texture& texture, const std::array<float, 4>& channels) {
    if (texture.channel_count < 3) return {channels[0], channels[0], channels[0]};
    return {channels[0], channels[1], channels[2]};
}

/// Bilinear value at (x, y), in texels from the centre of texel (0, 0); repeated in x.
Vec3f fetch_bilinear(const Texture& texture, float x, float y, WrapMode wrap_y) {
    const float whole_x = floor_texel(x), whole_y = floor_texel(y);
    const float fx = x - whole_x, fy = y - whole_y;
    const auto column = [&](int64_t i) { return uint32_t(wrap_index(i, texture.width, WrapMode::repeat)); };
    const auto row = [&](int64_t i) { return uint32_t(wrap_index(i, texture.height, wrap_y)); };
    const uint32_t x0 = column(int64_t(whole_x)), x1 = column(int64_t(whole_x) + 1);
    const uint32_t y0 = row(int64_t(whole_y)), y1 = row(int64_t(whole_y) + 1);
    return make_color(texture, filter_channels(read_channels(texture, x0, y0), read_channels(texture, x1, y0),
                                               read_channels(texture, x0, y1), read_channels(texture, x1, y1),
                                               fx, fy));
}

} // namespace

Vec3f fetch_texel(const Texture& texture, uint32_t x, uint32_t y) {
    return make_color(texture, read_channels(texture, x, y));
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
