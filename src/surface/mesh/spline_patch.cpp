#include "surface/mesh/spline_patch.h"

namespace relief {

namespace {

/// Uniform cubic B-spline weights (de Boor 1978) at s in [0, 1], and their derivatives.
struct SplineWeights {
    std::array<double, 4> value, slope;

    explicit SplineWeights(double s) {
        const double r = 1 - s, s2 = s * s, r2 = r * r;
        value = {r2 * r / 6, (4 - 6 * s2 + 3 * s2 * s) / 6, (4 - 6 * r2 + 3 * r2 * r) / 6, s2 * s / 6};
        slope = {-r2 / 2, (3 * s2 - 4 * s) / 2, (4 * r - 3 * r2) / 2, s2 / 2};
    }
};

Vec3d blend(const std::array<Vec3d, 4>& c, const std::array<double, 4>& w) {
    return c[0] * w[0] + c[1] * w[1] + c[2] * w[2] + c[3] * w[3];
}

} // namespace

LimitSample evaluate_spline(const SplineControls& controls, double u, double v, bool has_twist) {
    const SplineWeights along(u), across(v);
    std::array<Vec3d, 4> value, slope; // of the columns at v
    for (size_t column = 0; column < 4; ++column) {
        value[column] = blend(controls[column], across.value);
        slope[column] = blend(controls[column], across.slope);
    }
    return {blend(value, along.value), blend(value, along.slope), blend(slope, along.value),
            has_twist ? blend(slope, along.slope) : Vec3d{}};
}

Vec3d evaluate_spline_position(const SplineControls& controls, double u, double v) {
    const SplineWeights along(u), across(v);
    std::array<Vec3d, 4> value;
    for (size_t column = 0; column < 4; ++column) value[column] = blend(controls[column], across.value);
    return blend(value, along.value);
}

} // namespace relief
