#include "math/affine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix to_matrix(const Affine& m) {
    Matrix result;
    for (int r = 0; r < 3; ++r) result[r] = {m.rows[r].x, m.rows[r].y, m.rows[r].z};
    return result;
}

double compute_determinant(const Matrix& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

} // namespace

Affine compose(const Affine& outer, const Affine& inner) {
    Affine result;
    for (int r = 0; r < 3; ++r) {
        const Vec3f& row = outer.rows[r];
        result.rows[r] = inner.rows[0] * row.x + inner.rows[1] * row.y + inner.rows[2] * row.z;
    }
    result.translation = transform_point(outer, inner.translation);
    return result;
}

float compute_determinant(const Affine& m) { return float(compute_determinant(to_matrix(m))); }

double bound_scale(const Affine& m) {
    double squared = 0;
    for (const Vec3f& row : m.rows) squared += double(dot(row, row));
    return std::sqrt(squared);
}

std::optional<Affine> invert(const Affine& m) {
    const Matrix a = to_matrix(m);
    const double determinant = compute_determinant(a);
    double scale = 0;
    for (const auto& row : a)
        for (double value : row) scale = std::max(scale, std::fabs(value));
    if (!std::isfinite(determinant) || !is_finite(m.translation) || scale == 0 ||
        std::fabs(determinant) < 1e-18 * scale * scale * scale)
        return std::nullopt;
    const auto cofactor = [&](int r, int c) {
        const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        return a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1];
    };
    Affine result;
    for (int r = 0; r < 3; ++r) {
        std::array<double, 3> row;
        for (int c = 0; c < 3; ++c) row[c] = cofactor(c, r) / determinant;
        const double offset = row[0] * m.translation.x + row[1] * m.translation.y + row[2] * m.translation.z;
        result.rows[r] = {float(row[0]), float(row[1]), float(row[2])};
        set_component(result.translation, r, float(-offset));
    }
    return result;
}

Box transform_box(const Affine& m, const Box& box) {
    if (box.is_empty()) return box;
    Box result;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3f& row = m.rows[axis];
        double low = get_component(m.translation, axis), high = low, size = std::fabs(low);
        for (int k = 0; k < 3; ++k) {
            const double factor = get_component(row, k);
            const double a = factor * get_component(box.lower, k), b = factor * get_component(box.upper, k);
            low += std::min(a, b);
            high += std::max(a, b);
            size += std::max(std::fabs(a), std::fabs(b));
        }
        // Transforming a point in float arithmetic errs by at most a few ulp of the largest partial sum.
        const double slack = 8 * 0x1p-24 * size + 1e-37;
        set_component(result.lower, axis, float(low - slack));
        set_component(result.upper, axis, float(high + slack));
    }
    return result;
}

Affine make_translation(const Vec3f& offset) {
    Affine result;
    result.translation = offset;
    return result;
}

Affine make_scale(const Vec3f& factors) {
    Affine result;
    result.rows = {Vec3f{factors.x, 0, 0}, Vec3f{0, factors.y, 0}, Vec3f{0, 0, factors.z}};
    return result;
}

Affine make_rotation_degrees(const Vec3f& degrees) {
    const auto make_axis_rotation = [](int axis, double angle) {
        const double radians = angle * std::numbers::pi / 180;
        // Right angles are exact, so that rotated scenes keep watertight edges and flat boxes.
        const double quarter = angle / 90;
        const bool is_right_angle = quarter == std::floor(quarter);
        const float c = float(is_right_angle ? std::round(std::cos(radians)) : std::cos(radians));
        const float s = float(is_right_angle ? std::round(std::sin(radians)) : std::sin(radians));
        Affine m;
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        set_component(m.rows[i], i, c), set_component(m.rows[i], j, -s);
        set_component(m.rows[j], i, s), set_component(m.rows[j], j, c);
        return m;
    };
    return compose(make_axis_rotation(2, degrees.z),
                   compose(make_axis_rotation(1, degrees.y), make_axis_rotation(0, degrees.x)));
}

} // namespace relief
