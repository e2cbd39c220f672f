// What a displaced surface is: the exact float operations of one vertex, in the one order that every engine
// keeps. Shared edges are closed because both of their patches run these lines on the same numbers.
#ifndef RELIEF_DISPLACE_H
#ifndef __cplusplus
#define RELIEF_DISPLACE_H
#endif

/// Point at parameter s between a and b; exact at s = 0 and s = 1 for finite a, b.
FN Float blend(Float a, Float b, Float s) {
    EXACT Float r = a * (Float(1.0f) - s) + b * s;
    return r;
}

/// Bilinear value at (u, v) of corners c00 c10 c11 c01 (counter-clockwise): along u first, then along v.
FN Float blend_quad(Float c00, Float c10, Float c11, Float c01, Float u, Float v) {
    EXACT Float r = blend(blend(c00, c10, u), blend(c01, c11, u), v);
    return r;
}

/// Displacement channel of four texels: along x first, then along y (Heckbert 1989, bilinear filter).
FN Float filter_texels(Float t00, Float t10, Float t01, Float t11, Float fx, Float fy) {
    EXACT Float r = blend(blend(t00, t10, fx), blend(t01, t11, fx), fy);
    return r;
}

/// One row of the decode matrix applied to (value - midlevel).
FN Float decode_row(Float r, Float g, Float b, Float m0, Float m1, Float m2) {
    EXACT Float d = r * m0 + g * m1 + b * m2;
    return d;
}

/// One world coordinate of the displacement (t, b, n) carried through the frame's coordinates of T, B and N.
FN Float carry_through_frame(Float t, Float b, Float n, Float frame_t, Float frame_b, Float frame_n) {
    EXACT Float d = t * frame_t + b * frame_b + n * frame_n;
    return d;
}

#endif
