// From linear radiance to what a screen shows.
#ifndef RELIEF_TONEMAP_H
#ifndef __cplusplus
#define RELIEF_TONEMAP_H
#endif

/// Filmic curve: rational fit of the ACES reference transform (Narkowicz 2015, ACES Filmic Tone Mapping
/// Curve), exposed so that middle grey 0.18 stays 0.18. Rises from 0 at 0 to 1; negative and not-a-number
/// inputs give 0.
FN Float tone_map_filmic(Float x) {
    Float e = min(select(x > Float(0.0f), x, Float(0.0f)), Float(1e6f)) * Float(0.7231708f);
    Float mapped =
        (e * (Float(2.51f) * e + Float(0.03f))) / (e * (Float(2.43f) * e + Float(0.59f)) + Float(0.14f));
    return min(mapped, Float(1.0f));
}

/// sRGB transfer function (IEC 61966-2-1) for x in [0, 1].
FN Float encode_srgb(Float x) {
    return select(x <= Float(0.0031308f), Float(12.92f) * x,
                  Float(1.055f) * pow(max(x, Float(0.0031308f)), Float(1.0f / 2.4f)) - Float(0.055f));
}

/// Its inverse.
FN Float decode_srgb(Float x) {
    return select(x <= Float(0.04045f), x * Float(1.0f / 12.92f),
                  pow((max(x, Float(0.04045f)) + Float(0.055f)) * Float(1.0f / 1.055f), Float(2.4f)));
}

#endif
