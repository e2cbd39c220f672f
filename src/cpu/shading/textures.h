// Look-ups of colour textures and environments: bilinear on the raw texels, or by a B-spline.
#pragma once

#include "relief/scene.h"
#include "relief/types.h"

namespace relief::cpu {

/// First three channels of texel (x, y), inside the texture; a texture of one or two channels is grey.
Vec3f fetch_texel(const Texture& texture, uint32_t x, uint32_t y);

/// Bilinear value at uv, repeated both ways; row 0 is v = 1. Texel (0, 0) for a uv that is not finite.
Vec3f fetch_texture(const Texture& texture, const Vec2f& uv);

/// The same of a texture whose texels are coefficients of a uniform bicubic B-spline.
Vec3f fetch_spline(const Texture& texture, const Vec2f& uv);
inline Vec3f fetch_texture(const Texture& texture, MapFilter filter, const Vec2f& uv) {
    return is_smooth(filter) ? fetch_spline(texture, uv) : fetch_texture(texture, uv);
}

/// What `texture` is at uv where it does not repeat; not for WrapMode::repeat. 0 outside with
/// WrapMode::black.
Vec3f fetch_wrapped(const Texture& texture, MapFilter filter, WrapMode wrap, const Vec2f& uv);

/// Bilinear value of a latitude-longitude image at [0, 1]^2 from the top left: repeated in x, clamped in y.
Vec3f fetch_latlong(const Texture& texture, const Vec2f& position);

} // namespace relief::cpu
