// The edge functions of a triangle without rounding errors, where those would put a hit behind the ray's
// origin.
#ifndef RELIEF_EXACT_EDGE_H
#define RELIEF_EXACT_EDGE_H
#include "formulas/exact.h"

#include "formulas/begin.h"

/// A hit is in doubt where its place along the ray's major axis, times the sum of the edge functions, is no
/// greater than this much of (largest |x|) (largest |y|) (largest |z|) over the corners. Each edge function
/// has four roundings of products of |x| and |y|, and each rounding moves the place, a mean of z, by at most
/// twice the largest |z|. The rest of the factor leaves room for the roundings of the mean itself.
const float kEdgeRounding = 1.9073486328125e-6f; // 2^-19

/// The largest magnitude among three numbers.
FN float find_largest(const float a, const float b, const float c) {
    return max(max(abs(a), abs(b)), abs(c));
}

/// The upper twelve bits of a number (Dekker 1971): its rest has twelve bits too, so products of such parts
/// are exact.
FN float find_upper_bits(const float a) {
    EXACT float scaled = 4097.0f * a;
    EXACT float rest = scaled - a;
    EXACT float upper = scaled - rest;
    return upper;
}

/// a * b less `product`, which is a * b rounded: exact (Dekker 1971).
FN float find_product_error(const float a, const float b, const float product) {
    float upper_a = find_upper_bits(a);
    float upper_b = find_upper_bits(b);
    EXACT float lower_a = a - upper_a;
    EXACT float lower_b = b - upper_b;
    EXACT float error =
        ((upper_a * upper_b - product) + upper_a * lower_b + lower_a * upper_b) + lower_a * lower_b;
    return error;
}

/// The edge function from one corner to another, rounded at its end alone. `rounded` is the same in single
/// precision: where that is zero, the edge counts as inside, so it stays zero.
FN float find_exact_edge(const float from_x, const float from_y, const float to_x, const float to_y,
                         const float rounded) {
    EXACT float first = from_x * to_y;
    EXACT float second = from_y * to_x;
    float first_error = find_product_error(from_x, to_y, first);
    float second_error = find_product_error(from_y, to_x, second);
    EXACT float edge = (first - second) + (first_error - second_error);
    return rounded == 0.0f ? 0.0f : edge;
}

#include "formulas/end.h"
#endif
