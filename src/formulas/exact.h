// Vector arithmetic in which every operation rounds once, in a fixed order, in C++ and GLSL alike. Everything
// that determines surface positions uses it.
#ifndef RELIEF_EXACT_H
#define RELIEF_EXACT_H
#include "formulas/cross.h"

#include "formulas/begin.h"

FN Vec3 add_exact(const Vec3 a, const Vec3 b) {
    EXACT Vec3 r = a + b;
    return r;
}

FN Vec3 subtract_exact(const Vec3 a, const Vec3 b) {
    EXACT Vec3 r = a - b;
    return r;
}

FN Vec3 scale_exact(const Vec3 a, const float s) {
    EXACT Vec3 r = a * s;
    return r;
}

FN float dot_exact(const Vec3 a, const Vec3 b) {
    EXACT float r = a.x * b.x + a.y * b.y + a.z * b.z;
    return r;
}

/// The upper twelve bits of a number. The rest has twelve bits too, so that products of such parts are exact
/// (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
FN float find_upper_bits(const float a) {
    EXACT float scaled = a * 4097.0f;
    EXACT float upper = scaled - (scaled - a);
    return upper;
}

/// Returns the exact difference between a * b and `product`, which is a * b rounded (Dekker 1971). Not by
/// fma(), which a device may round twice.
FN float find_product_error(const float a, const float b, const float product) {
    float upper_a = find_upper_bits(a);
    float upper_b = find_upper_bits(b);
    EXACT float lower_a = a - upper_a;
    EXACT float lower_b = b - upper_b;
    EXACT float error =
        ((upper_a * upper_b - product) + upper_a * lower_b + lower_a * upper_b) + lower_a * lower_b;
    return error;
}

FN uint min_uint(const uint a, const uint b) { return a < b ? a : b; }

/// Component 0, 1 or 2.
FN float select_axis(const Vec3 v, const uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

#include "formulas/end.h"
#endif
