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

FN uint min_uint(const uint a, const uint b) { return a < b ? a : b; }

/// Component 0, 1 or 2.
FN float select_axis(const Vec3 v, const uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

#include "formulas/end.h"
#endif
