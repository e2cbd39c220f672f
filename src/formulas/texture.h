// Bilinear look-ups of colour textures.
#ifndef RELIEF_TEXTURE_H
#define RELIEF_TEXTURE_H
#include "formulas/texture_uv.h"

#include "formulas/begin.h"

/// As locate_texture_uv without repeating: places far outside stay there. For all modes but kWrapRepeat.
FN Vec2 locate_wrapped_uv(const Vec2 uv, const Vec2 size) {
    float far = 4194304.0f; // texels: the place between two of them is still known
    Vec2 result = {clamp(uv.x * size.x - 0.5f, -far, far), clamp((1.0f - uv.y) * size.y - 0.5f, -far, far)};
    return result;
}

/// Of UDIM `u` and `v`, places of tiles: u in [0, 10). kNoUdim outside.
const uint kNoUdim = 0xffffffffu;
FN uint find_udim(const float u, const float v) {
    bool is_inside = u >= 0.0f && u < 10.0f && v >= 0.0f && v < 1000.0f;
    return is_inside ? uint(v) * 10u + uint(u) : kNoUdim;
}

/// Colour of a texel or interpolated value; textures of one or two channels are grey.
FN Vec3 make_texture_color(const uint channel_count, const Vec3 channels) {
    Vec3 grey = {channels.x, channels.x, channels.x};
    return select(channel_count < 3u, grey, channels);
}

#include "formulas/end.h"
#endif
