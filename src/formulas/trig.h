// Sine, cosine and their inverses as polynomials (Moshier 1992, Cephes, single precision): bit-identical on
// all instruction sets, and equal on devices up to rounding, unlike math libraries.
#if !defined(RELIEF_TRIG_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_TRIG_H
#include "formulas/constants.h"
#endif
#include "formulas/begin.h"

struct SinCos {
    Float sine, cosine;
};

/// For angles in radians up to some thousands; error 1e-7.
FN SinCos find_sin_cos(const Float angle) {
    Float quarters = floor(angle * Float(0.63661977236758134f) + Float(0.5f));
    // Cody-Waite reduction: pi / 2 in three parts, so that the first two products are exact.
    Float x = angle - quarters * Float(1.5703125f);
    x = x - quarters * Float(4.837512969970703125e-4f);
    x = x - quarters * Float(7.54978995489188216e-8f);
    Float x2 = x * x;
    Float s = Float(8.3321608736e-3f) - x2 * Float(1.9515295891e-4f);
    s = x + x * x2 * (x2 * s - Float(1.6666654611e-1f));
    Float c = Float(2.443315711809948e-5f) * x2 - Float(1.388731625493765e-3f);
    c = Float(1.0f) - Float(0.5f) * x2 + x2 * x2 * (x2 * c + Float(4.166664568298827e-2f));
    Float quadrant = quarters - Float(4.0f) * floor(quarters * Float(0.25f));
    Bool is_even = quadrant == Float(0.0f) || quadrant == Float(2.0f);
    Float sine = select(is_even, s, c);
    Float cosine = select(is_even, c, s);
    SinCos result = {
        select(quadrant >= Float(2.0f), Float(0.0f) - sine, sine),
        select(quadrant == Float(1.0f) || quadrant == Float(2.0f), Float(0.0f) - cosine, cosine)};
    return result;
}

/// Angle of the point (x, y) from the x axis, in [-pi, pi]; 0 for (0, 0). Error 4e-7.
FN Float find_angle(const Float y, const Float x) {
    Float low = min(abs(x), abs(y));
    Float high = max(abs(x), abs(y));
    Float ratio = low / select(high > Float(0.0f), high, Float(1.0f));
    Bool is_steep = ratio > Float(0.41421356237309505f); // tan(pi / 8)
    Float t = select(is_steep, (ratio - Float(1.0f)) / (ratio + Float(1.0f)), ratio);
    Float t2 = t * t;
    Float p = Float(8.05374449538e-2f) * t2 - Float(1.38776856032e-1f);
    p = (p * t2 + Float(1.99777106478e-1f)) * t2 - Float(3.33329491539e-1f);
    Float angle = select(is_steep, Float(0.25f * kPi), Float(0.0f)) + (p * t2 * t + t);
    angle = select(abs(y) > abs(x), Float(0.5f * kPi) - angle, angle);
    angle = select(x < Float(0.0f), Float(kPi) - angle, angle);
    return select(y < Float(0.0f), Float(0.0f) - angle, angle);
}

/// Arc cosine of a value in [-1, 1]. Error 4e-7.
FN Float find_arc_cosine(const Float cosine) {
    Float magnitude = abs(cosine);
    Bool is_far = magnitude > Float(0.5f);
    Float half_square = Float(0.5f) * (Float(1.0f) - magnitude);
    Float s = select(is_far, sqrt(max(half_square, Float(0.0f))), magnitude);
    Float s2 = s * s;
    Float p = (Float(4.2163199048e-2f) * s2 + Float(2.4181311049e-2f)) * s2 + Float(4.5470025998e-2f);
    p = (p * s2 + Float(7.4953002686e-2f)) * s2 + Float(1.6666752422e-1f);
    Float arc_sine = p * s2 * s + s;
    Float angle = select(is_far, Float(2.0f) * arc_sine, Float(0.5f * kPi) - arc_sine);
    return select(cosine < Float(0.0f), Float(kPi) - angle, angle);
}

#include "formulas/end.h"
#endif
