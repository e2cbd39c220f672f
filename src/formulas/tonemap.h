// Tone mapping and the sRGB transfer function.
#ifndef RELIEF_TONEMAP_H
#define RELIEF_TONEMAP_H
#include "formulas/begin.h"

FN Float bend_filmic(const Float x) {
    return (x * (x + Float(0.0245786f)) - Float(0.000090537f)) /
           (x * (Float(0.983729f) * x + Float(0.4329510f)) + Float(0.238081f));
}

/// Input of the curve: exposed so that middle grey 0.18 stays 0.18, infinities clamped.
FN Float expose_filmic(const Float x) {
    return min(select(x > Float(0.0f), x, Float(0.0f)), Float(1e6f)) * Float(1.461927f);
}

/// Filmic tone map of a linear Rec.709 colour into [0, 1], still linear: S. Hill's fit of the ACES transforms
/// (BakingLab, 2015). Bright colours desaturate. Negative and NaN components count as 0.
FN Vec3 tone_map_filmic(const Vec3 c) {
    Float r = expose_filmic(c.x);
    Float g = expose_filmic(c.y);
    Float b = expose_filmic(c.z);
    Float x = bend_filmic(Float(0.59719f) * r + Float(0.35458f) * g + Float(0.04823f) * b);
    Float y = bend_filmic(Float(0.07600f) * r + Float(0.90834f) * g + Float(0.01566f) * b);
    Float z = bend_filmic(Float(0.02840f) * r + Float(0.13383f) * g + Float(0.83777f) * b);
    Vec3 shown = c;
    shown.x =
        clamp(Float(1.60475f) * x - Float(0.53108f) * y - Float(0.07367f) * z, Float(0.0f), Float(1.0f));
    shown.y =
        clamp(Float(-0.10208f) * x + Float(1.10813f) * y - Float(0.00605f) * z, Float(0.0f), Float(1.0f));
    shown.z =
        clamp(Float(-0.00327f) * x - Float(0.07276f) * y + Float(1.07602f) * z, Float(0.0f), Float(1.0f));
    return shown;
}

/// sRGB transfer function (IEC 61966-2-1) for x in [0, 1].
FN Float encode_srgb(const Float x) {
    return select(x <= Float(0.0031308f), Float(12.92f) * x,
                  Float(1.055f) * pow(max(x, Float(0.0031308f)), Float(1.0f / 2.4f)) - Float(0.055f));
}

/// Its inverse.
FN Float decode_srgb(const Float x) {
    return select(x <= Float(0.04045f), x * Float(1.0f / 12.92f),
                  pow((max(x, Float(0.04045f)) + Float(0.055f)) * Float(1.0f / 1.055f), Float(2.4f)));
}

#include "formulas/end.h"
#endif
