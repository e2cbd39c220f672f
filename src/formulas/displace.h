// Definition of the displaced surface: the float operations of one vertex in the exact order that every
// engine follows. Shared edges are watertight because both patches evaluate these lines on the same numbers.
#if !defined(RELIEF_DISPLACE_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_DISPLACE_H
#endif
#include "formulas/begin.h"

/// Point at parameter s between a and b; exact at s = 0 and s = 1 for finite a, b.
FN Float blend(const Float a, const Float b, const Float s) {
    EXACT Float r = a * (Float(1.0f) - s) + b * s;
    return r;
}

/// Bilinear value at (u, v) of corners c00 c10 c11 c01 (counter-clockwise): along u first, then along v.
FN Float blend_quad(const Float c00, const Float c10, const Float c11, const Float c01, const Float u,
                    const Float v) {
    EXACT Float r = blend(blend(c00, c10, u), blend(c01, c11, u), v);
    return r;
}

/// Weights of the four control points of a cubic curve (Bernstein 1912).
struct CubicWeights {
    Float first, second, third, fourth;
};

/// At parameter s. One weight is nonzero at s = 0 and s = 1; weights at 1 - s, where exact, are reversed.
FN CubicWeights weigh_cubic(const Float s) {
    EXACT Float r = Float(1.0f) - s;
    EXACT Float both = Float(3.0f) * (s * r);
    EXACT Float first = r * r * r;
    EXACT Float second = both * r;
    EXACT Float third = both * s;
    EXACT Float fourth = s * s * s;
    CubicWeights weights = {first, second, third, fourth};
    return weights;
}

/// Point of a cubic Bezier curve, the same from either end. Patches: along v by columns, then along u.
FN Float blend_cubic(const Float p0, const Float p1, const Float p2, const Float p3,
                     const CubicWeights weights) {
    EXACT Float ends = p0 * weights.first + p3 * weights.fourth;
    EXACT Float inner = p1 * weights.second + p2 * weights.third;
    EXACT Float r = ends + inner;
    return r;
}

/// Weights at s in [0, 1) of the coefficients at -1, 0, 1 and 2 of a uniform cubic B-spline (de Boor 1978):
/// none is negative and their sum is 1, both up to rounding.
FN CubicWeights weigh_spline(const Float s) {
    const Float sixth = Float(0.16666667163372039794921875f);
    const Float two_thirds = Float(0.66666668653488159179687500f);
    EXACT Float r = Float(1.0f) - s;
    EXACT Float first = r * r * r * sixth;
    EXACT Float second = two_thirds - s * s * (Float(1.0f) - Float(0.5f) * s);
    EXACT Float third = two_thirds - r * r * (Float(1.0f) - Float(0.5f) * r);
    EXACT Float fourth = s * s * s * sixth;
    CubicWeights weights = {first, second, third, fourth};
    return weights;
}

/// Derivative at s of the cubic curve whose neighbouring control points differ by d0 d1 d2.
FN Float blend_slope(const Float d0, const Float d1, const Float d2, const Float s) {
    Float r = Float(1.0f) - s;
    return Float(3.0f) * (d0 * r * r + Float(2.0f) * d1 * s * r + d2 * s * s);
}

/// Displacement channel of four texels: along x first, then along y (Heckbert 1989, bilinear filter).
FN Float filter_texels(const Float t00, const Float t10, const Float t01, const Float t11, const Float fx,
                       const Float fy) {
    EXACT Float r = blend(blend(t00, t10, fx), blend(t01, t11, fx), fy);
    return r;
}

/// One row of the decode matrix applied to (value - midlevel).
FN Float decode_row(const Float r, const Float g, const Float b, const Float m0, const Float m1,
                    const Float m2) {
    EXACT Float d = r * m0 + g * m1 + b * m2;
    return d;
}

/// One world coordinate of the displacement (t, b, n), given that coordinate of T, B and N.
FN Float carry_through_frame(const Float t, const Float b, const Float n, const Float frame_t,
                             const Float frame_b, const Float frame_n) {
    EXACT Float d = t * frame_t + b * frame_b + n * frame_n;
    return d;
}

#include "formulas/end.h"
#endif
