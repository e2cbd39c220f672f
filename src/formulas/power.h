// Powers and logarithms of base 2 as polynomials, as formulas/trig.h: bit-identical on all instruction sets.
#if !defined(RELIEF_POWER_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_POWER_H
#endif
#include "formulas/begin.h"

/// 2^x for x in [-126, 126], beyond which it stays. Relative error 4e-7.
FN Float find_power_of_two(const Float x) {
    Float limited = clamp(x, Float(-126.0f), Float(126.0f));
    Float whole = floor(limited + Float(0.5f));
    Float f = (limited - whole) * Float(0.69314718056f);
    Float p = Float(1.0f / 720.0f) + f * Float(1.0f / 5040.0f);
    p = Float(1.0f / 24.0f) + f * (Float(1.0f / 120.0f) + f * p);
    p = Float(1.0f) + f * (Float(1.0f) + f * (Float(0.5f) + f * (Float(1.0f / 6.0f) + f * p)));
    return p * uintBitsToFloat(Uint(whole + Float(127.0f)) << 23u);
}

/// Logarithm of a positive normal number to base 2. Error 2e-7 of 1, or of the result.
FN Float find_logarithm(const Float x) {
    Uint bits = floatBitsToUint(x);
    Float exponent = Float(bits >> 23u) - Float(127.0f);
    Float m = uintBitsToFloat((bits & Uint(0x7fffffu)) | Uint(0x3f800000u));
    Bool is_high = m > Float(1.41421356f);
    m = select(is_high, Float(0.5f) * m, m);
    exponent = select(is_high, exponent + Float(1.0f), exponent);
    Float t = (m - Float(1.0f)) / (m + Float(1.0f));
    Float t2 = t * t;
    Float p = Float(1.0f / 5.0f) + t2 * (Float(1.0f / 7.0f) + t2 * Float(1.0f / 9.0f));
    p = Float(1.0f) + t2 * (Float(1.0f / 3.0f) + t2 * p);
    return exponent + Float(2.8853900818f) * t * p;
}

#include "formulas/end.h"
#endif
