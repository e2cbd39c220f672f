// Edge functions of a triangle that are nearly free of rounding errors. They are needed where the ray grazes
// a long and narrow triangle: its edge functions are small beside the products that they are differences of,
// so that rounding moves the place of the hit by much of the triangle's length. Hits are refined where
// rounding may have put them on the wrong side of the ray's origin. The other end of the ray, t_max, is not
// treated in this way.
#ifndef RELIEF_EXACT_EDGE_H
#define RELIEF_EXACT_EDGE_H
#include "formulas/exact.h"

#include "formulas/begin.h"

/// A hit is in doubt where |u a.z + v b.z + w c.z|, which is its place along the ray's major axis times the
/// sum of the edge functions, is no greater than this share of (largest |x|) (largest |y|) (largest |z|) over
/// the corners a, b and c. Each of the three edge functions has four roundings of 2^-24 of products of |x|
/// and |y|, and each rounding counts at most twice in a mean of z: 1.5 x 2^-20 in all. The mean itself adds
/// at most 2^-20.
const float kEdgeRounding = 1.9073486328125e-6f; // 2^-19

/// The largest magnitude among three numbers.
FN float find_largest(const float a, const float b, const float c) {
    return max(max(abs(a), abs(b)), abs(c));
}

/// The edge function from one corner to another. Its error is about one unit in its last place, and its sign
/// is never wrong. It may be zero where the exact value is not.
FN float find_exact_edge(const float from_x, const float from_y, const float to_x, const float to_y) {
    EXACT float first = from_x * to_y;
    EXACT float second = from_y * to_x;
    float first_error = find_product_error(from_x, to_y, first);
    float second_error = find_product_error(from_y, to_x, second);
    EXACT float edge = (first - second) + (first_error - second_error);
    return edge;
}

#include "formulas/end.h"
#endif
