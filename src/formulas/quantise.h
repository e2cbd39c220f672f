// Boxes quantised to 16 bits per bound: origin + code * scale with a power of two for scale, so that the
// product is exact and all decoders agree. Codes are rounded outward and verified with the decoder.
#ifndef RELIEF_QUANTISE_H
#define RELIEF_QUANTISE_H
#include "formulas/begin.h"

FN float decode_bound(const float origin, const float scale, const uint code) {
    EXACT float bound = origin + float(code) * scale;
    return bound;
}

/// Order-preserving map of floats to unsigned integers, and its inverse.
FN uint order_float(const float x) {
    uint bits = floatBitsToUint(x);
    return bits ^ ((bits & 0x80000000u) != 0u ? 0xffffffffu : 0x80000000u);
}
FN float unorder_float(const uint bits) {
    return uintBitsToFloat(bits ^ ((bits & 0x80000000u) != 0u ? 0x80000000u : 0xffffffffu));
}

/// Least power of two for which 65534 steps reach at least `extent` (>= 0, finite).
FN float choose_scale(const float extent) {
    uint exponent = (floatBitsToUint(extent * (1.0f / 65534.0f)) >> 23u) + 1u;
    exponent = exponent < 24u ? 24u : exponent;
    return uintBitsToFloat(exponent << 23u);
}

/// Greatest code whose bound is at most `value`, which lies in [origin, origin + 65534 scale].
FN uint encode_lower(const float value, const float origin, const float scale) {
    EXACT float steps = (value - origin) / scale;
    uint code = uint(clamp(floor(steps), 0.0f, 65534.0f));
    return code > 0u && decode_bound(origin, scale, code) > value ? code - 1u : code;
}

/// Least code whose bound is at least `value`.
FN uint encode_upper(const float value, const float origin, const float scale) {
    EXACT float steps = (value - origin) / scale;
    uint code = uint(clamp(floor(steps) + 1.0f, 0.0f, 65535.0f));
    if (code > 0u && decode_bound(origin, scale, code - 1u) >= value) code -= 1u;
    return code < 65535u && decode_bound(origin, scale, code) < value ? code + 1u : code;
}

#include "formulas/end.h"
#endif
