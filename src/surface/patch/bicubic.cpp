#include "surface/patch/bicubic.h"

#include <algorithm>
#include <limits>

namespace relief {

namespace {

using Coefficients = std::array<double, 4>;

double blossom(const Coefficients& c, double a, double b, double d) {
    const auto blend = [](double x, double y, double s) { return x * (1 - s) + y * s; };
    const double c01 = blend(c[0], c[1], a), c12 = blend(c[1], c[2], a), c23 = blend(c[2], c[3], a);
    return blend(blend(c01, c12, b), blend(c12, c23, b), d);
}

/// Control points of the part [s0, s1] (Ramshaw 1989, Blossoms are polar forms).
Coefficients restrict_curve(const Coefficients& c, double s0, double s1) {
    return {blossom(c, s0, s0, s0), blossom(c, s0, s0, s1), blossom(c, s0, s1, s1), blossom(c, s1, s1, s1)};
}

std::array<double, 2> find_range(const Coefficients& c) {
    const auto [low, high] = std::minmax_element(c.begin(), c.end());
    return {*low, *high};
}

} // namespace

CoordinateRanges bound_part(const BicubicBase& base, const std::array<double, 4>& u0_v0_u1_v1) {
    const auto [u0, v0, u1, v1] = u0_v0_u1_v1;
    CoordinateRanges ranges;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<Coefficients, 4> columns;
        for (size_t column = 0; column < 4; ++column) {
            Coefficients curve;
            for (size_t row = 0; row < 4; ++row) curve[row] = get_component(base.columns[column][row], axis);
            columns[column] = restrict_curve(curve, v0, v1);
        }
        ranges[size_t(axis)] = {std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
        for (size_t row = 0; row < 4; ++row) {
            const std::array<double, 2> range = find_range(
                restrict_curve({columns[0][row], columns[1][row], columns[2][row], columns[3][row]}, u0, u1));
            ranges[size_t(axis)][0] = std::min(ranges[size_t(axis)][0], range[0]);
            ranges[size_t(axis)][1] = std::max(ranges[size_t(axis)][1], range[1]);
        }
    }
    return ranges;
}

CoordinateRanges bound_curve(const std::array<Vec3f, 4>& controls, const std::array<double, 2>& s0_s1) {
    CoordinateRanges ranges;
    for (int axis = 0; axis < 3; ++axis) {
        Coefficients curve;
        for (size_t k = 0; k < 4; ++k) curve[k] = get_component(controls[k], axis);
        ranges[size_t(axis)] = find_range(restrict_curve(curve, s0_s1[0], s0_s1[1]));
    }
    return ranges;
}

} // namespace relief
