// The bicubic base of a patch: corners and inner control points, evaluated as in formulas/displace.h.
#pragma once

#include <array>

#include "formulas/control_points.h"
#include "formulas/displace.h"
#include "surface/patch/surface.h"

namespace relief {

inline Vec3f blend_cubic(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
                         const scalar::CubicWeights& weights) {
    return {scalar::blend_cubic(a.x, b.x, c.x, d.x, weights),
            scalar::blend_cubic(a.y, b.y, c.y, d.y, weights),
            scalar::blend_cubic(a.z, b.z, c.z, d.z, weights)};
}

inline Vec3f blend_slope(const Vec3f& a, const Vec3f& b, const Vec3f& c, float s) {
    return {scalar::blend_slope(a.x, b.x, c.x, s), scalar::blend_slope(a.y, b.y, c.y, s),
            scalar::blend_slope(a.z, b.z, c.z, s)};
}

/// Control points of one patch by column (along u) and row (along v).
struct BicubicBase {
    std::array<std::array<Vec3f, 4>, 4> columns;

    BicubicBase(const std::array<Vec3f, 4>& corners, const InnerControls& inner) {
        for (uint32_t column = 0; column < 4; ++column)
            for (uint32_t row = 0; row < 4; ++row) {
                const uint32_t k = scalar::find_control_point(column, row);
                columns[column][row] = k < 4 ? corners[k] : inner[k - 4];
            }
    }

    Vec3f evaluate(float u, float v) const {
        const scalar::CubicWeights across = scalar::weigh_cubic(v);
        const auto point = [&](size_t column) {
            const std::array<Vec3f, 4>& c = columns[column];
            return blend_cubic(c[0], c[1], c[2], c[3], across);
        };
        return blend_cubic(point(0), point(1), point(2), point(3), scalar::weigh_cubic(u));
    }

    /// Derivative along u.
    Vec3f differentiate_u(float u, float v) const {
        const scalar::CubicWeights across = scalar::weigh_cubic(v);
        const auto difference = [&](size_t column) {
            const std::array<Vec3f, 4>&a = columns[column], &b = columns[column + 1];
            return blend_cubic(b[0] - a[0], b[1] - a[1], b[2] - a[2], b[3] - a[3], across);
        };
        return blend_slope(difference(0), difference(1), difference(2), u);
    }

    /// Derivative along v.
    Vec3f differentiate_v(float u, float v) const {
        const scalar::CubicWeights along = scalar::weigh_cubic(u);
        const auto difference = [&](size_t row) {
            return blend_cubic(columns[0][row + 1] - columns[0][row], columns[1][row + 1] - columns[1][row],
                               columns[2][row + 1] - columns[2][row], columns[3][row + 1] - columns[3][row],
                               along);
        };
        return blend_slope(difference(0), difference(1), difference(2), v);
    }
};

/// Least and greatest coordinates [axis], in double precision.
using CoordinateRanges = std::array<std::array<double, 2>, 3>;

/// Hull of the control points of the part [u0, u1] x [v0, v1] (de Casteljau's algorithm).
CoordinateRanges bound_part(const BicubicBase& base, const std::array<double, 4>& u0_v0_u1_v1);
/// The same of a cubic curve between s0 and s1.
CoordinateRanges bound_curve(const std::array<Vec3f, 4>& controls, const std::array<double, 2>& s0_s1);

} // namespace relief
