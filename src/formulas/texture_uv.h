// Places of look-ups in colour textures that repeat.
#if !defined(RELIEF_TEXTURE_UV_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_TEXTURE_UV_H
#include "formulas/texel.h"
#endif
#include "formulas/begin.h"

/// uv in texels from the centre of texel (0, 0), row 0 at v = 1; the integer part goes first for precision.
FN Vec2 locate_texture_uv(const Vec2 uv, const Vec2 size) {
    Vec2 result = {(uv.x - floor_texel(uv.x)) * size.x - Float(0.5f),
                   (Float(1.0f) - (uv.y - floor_texel(uv.y))) * size.y - Float(0.5f)};
    return result;
}

#include "formulas/end.h"
#endif
