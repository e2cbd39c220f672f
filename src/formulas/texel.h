// Addressing of texels.
#ifndef RELIEF_TEXEL_H
#define RELIEF_TEXEL_H
#include "formulas/begin.h"

const uint kWrapClamp = 0u;
const uint kWrapRepeat = 1u;
const uint kWrapMirror = 2u;
const uint kWrapBlack = 3u;

/// floor() without a library call where rounding instructions lack; non-finite values stay.
FN float floor_texel(const float x) {
    if (!(abs(x) < 8388608.0f)) return x;
    float whole = float(int(x));
    return whole > x ? whole - 1.0f : whole;
}

/// Column or row for `index` in a map of `size` texels; -1 outside with kWrapBlack.
FN int wrap_texel(const int index, const int size, const uint wrap) {
    if (index >= 0 && index < size) return index;
    if (wrap == kWrapClamp) return index < 0 ? 0 : size - 1;
    if (wrap == kWrapBlack) return -1;
    int period = wrap == kWrapMirror ? 2 * size : size;
    int rest = index % period;
    // GLSL leaves % of a negative operand undefined: recompute without one.
    if (index < 0) rest = period - 1 - (-(index + 1)) % period;
    return rest < size ? rest : period - 1 - rest;
}

/// Texels beside a map of `size` texels that continue it where no other tile does; what is farther is not
/// displaced.
FN int find_tile_margin(const int size) { return 2 + size / 256; }

/// Tiles that texels are looked for in on the way from one of them.
const int kMostTileSteps = 16;

/// Place of texel `index` of a map of `size` texels among the `other_size` texels of another map of its
/// place.
FN float scale_texel_place(const int index, const int size, const int other_size) {
    EXACT float place = (float(index) + 0.5f) * (float(other_size) / float(size)) - 0.5f;
    return place;
}

#include "formulas/end.h"
#endif
