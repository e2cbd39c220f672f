#include "cpu/shading/textures.h"

#include <cmath>

#include "formulas/environment.h"
#include "formulas/texture.h"
#include "surface/map/texels.h"

namespace relief::cpu {

namespace {

Vec3f make_color(const Texture& texture, const std::array<float, 4>& channels) {
    return scalar::make_texture_color(texture.channel_count, {channels[0], channels[1], channels[2]});
}

Vec2f size_of(const Texture& texture) { return {float(texture.width), float(texture.height)}; }

/// The four texels about a place in texels from the centre of texel (0, 0); repeated in x.
struct FourTexels {
    uint32_t x0, x1, y0, y1;
    float fx, fy;
};

FourTexels find_four_texels(const Texture& texture, const Vec2f& at, WrapMode wrap_y) {
    const float whole_x = floor_texel(at.x), whole_y = floor_texel(at.y);
    const auto column = [&](int64_t i) { return uint32_t(wrap_index(i, texture.width, WrapMode::repeat)); };
    const auto row = [&](int64_t i) { return uint32_t(wrap_index(i, texture.height, wrap_y)); };
    const int64_t x = int64_t(whole_x), y = int64_t(whole_y);
    return {column(x), column(x + 1), row(y), row(y + 1), at.x - whole_x, at.y - whole_y};
}

Vec3f fetch_bilinear(const Texture& texture, const FourTexels& at) {
    return make_color(texture, filter_channels(read_channels(texture, at.x0, at.y0),
                                               read_channels(texture, at.x1, at.y0),
                                               read_channels(texture, at.x0, at.y1),
                                               read_channels(texture, at.x1, at.y1), at.fx, at.fy));
}

FourTexels find_latlong(const Texture& texture, const Vec2f& position) {
    return find_four_texels(texture, scalar::locate_latlong(position, size_of(texture)), WrapMode::clamp);
}

} // namespace

Vec3f fetch_texel(const Texture& texture, uint32_t x, uint32_t y) {
    return make_color(texture, read_channels(texture, x, y));
}

Vec3f fetch_texture(const Texture& texture, const Vec2f& uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fetch_texel(texture, 0, 0);
    return fetch_bilinear(texture, find_four_texels(texture, scalar::locate_texture_uv(uv, size_of(texture)),
                                                    WrapMode::repeat));
}

Vec3f fetch_spline(const Texture& texture, const Vec2f& uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fetch_texel(texture, 0, 0);
    const Vec2f at = scalar::locate_texture_uv(uv, size_of(texture));
    const float whole_x = floor_texel(at.x), whole_y = floor_texel(at.y);
    const auto read = [&](size_t i, size_t j) {
        return read_channels(texture,
                             wrap_index(int64_t(whole_x) - 1 + int64_t(i), texture.width, WrapMode::repeat),
                             wrap_index(int64_t(whole_y) - 1 + int64_t(j), texture.height, WrapMode::repeat));
    };
    return make_color(texture, filter_spline(read, at.x - whole_x, at.y - whole_y));
}

Vec3f fetch_wrapped(const Texture& texture, MapFilter filter, WrapMode wrap, const Vec2f& uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fetch_texel(texture, 0, 0);
    const Vec2f at = scalar::locate_wrapped_uv(uv, size_of(texture));
    const float whole_x = floor_texel(at.x), whole_y = floor_texel(at.y);
    const auto read = [&](int64_t i, int64_t j) {
        const int64_t x = wrap_index(int64_t(whole_x) + i, texture.width, wrap);
        const int64_t y = wrap_index(int64_t(whole_y) + j, texture.height, wrap);
        return x < 0 || y < 0 ? std::array<float, 4>{} : read_channels(texture, x, y);
    };
    const float fx = at.x - whole_x, fy = at.y - whole_y;
    if (!is_smooth(filter))
        return make_color(texture, filter_channels(read(0, 0), read(1, 0), read(0, 1), read(1, 1), fx, fy));
    const auto read_around = [&](size_t i, size_t j) { return read(int64_t(i) - 1, int64_t(j) - 1); };
    return make_color(texture, filter_spline(read_around, fx, fy));
}

Vec3f fetch_latlong(const Texture& texture, const Vec2f& position) {
    return fetch_bilinear(texture, find_latlong(texture, position));
}

} // namespace relief::cpu
