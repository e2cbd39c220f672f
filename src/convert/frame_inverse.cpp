#include "convert/frame_inverse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "math/vec.h"

namespace relief {

namespace {

using Column = std::array<double, 3>;
using Matrix = std::array<Column, 3>; ///< columns

double dot(const Column& a, const Column& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Eigenvalues on the diagonal of `symmetric`, eigenvectors as columns (Jacobi 1846).
Matrix diagonalize(Matrix& symmetric) {
    constexpr int kSweeps = 8;
    Matrix vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const auto& [p, q] : {std::pair<size_t, size_t>(0, 1), {0, 2}, {1, 2}}) {
            if (symmetric[p][q] == 0) continue;
            const double angle = 0.5 * std::atan2(2 * symmetric[p][q], symmetric[q][q] - symmetric[p][p]);
            const double c = std::cos(angle), s = std::sin(angle);
            const auto rotate = [&](double& a, double& b) {
                const double before = a;
                a = c * before - s * b, b = s * before + c * b;
            };
            for (size_t k = 0; k < 3; ++k) rotate(symmetric[k][p], symmetric[k][q]);
            for (size_t k = 0; k < 3; ++k) rotate(symmetric[p][k], symmetric[q][k]);
            for (size_t k = 0; k < 3; ++k) rotate(vectors[p][k], vectors[q][k]);
        }
    return vectors;
}

/// Columns in lengths of those at the corners.
Matrix make_unit_columns(const TexelFrame& frame) {
    Matrix columns;
    for (size_t c = 0; c < 3; ++c) {
        const Vec3f& axis = frame.axes[c];
        const double scale = frame.lengths[c] > 0 ? 1 / double(frame.lengths[c]) : 0;
        columns[c] = {axis.x * scale, axis.y * scale, axis.z * scale};
    }
    return columns;
}

/// Gershgorin's circles hold the eigenvalues: this is true for most frames and needs no eigenvalues.
bool is_surely_sound(const Matrix& squares) {
    for (size_t r = 0; r < 3; ++r) {
        const double others = std::fabs(squares[r][(r + 1) % 3]) + std::fabs(squares[r][(r + 2) % 3]);
        if (!(squares[r][r] - others >= kLeastStretch * kLeastStretch)) return false;
    }
    return true;
}

/// Least squares of columns x = d with small x along what the columns hardly reach.
Column solve_damped(const Matrix& columns, const Matrix& vectors, const Column& values, const Column& d) {
    const Column projected{dot(columns[0], d), dot(columns[1], d), dot(columns[2], d)};
    Column x{};
    for (size_t k = 0; k < 3; ++k) {
        const double weight = dot(vectors[k], projected) / std::max(values[k], kLeastStretch * kLeastStretch);
        for (size_t c = 0; c < 3; ++c) x[c] += weight * vectors[k][c];
    }
    return x;
}

Vec3f invert(const FrameMatrix& axes, const Vec3f& d) {
    const Vec3f bn = cross(axes[1], axes[2]), nt = cross(axes[2], axes[0]), tb = cross(axes[0], axes[1]);
    return Vec3f{dot(bn, d), dot(nt, d), dot(tb, d)} / dot(axes[0], bn);
}

} // namespace

FrameCoordinates invert_frame(const TexelFrame& frame, const Vec3f& d) {
    const Matrix columns = make_unit_columns(frame);
    Matrix squares;
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) squares[c][r] = dot(columns[r], columns[c]);
    if (is_surely_sound(squares)) return {invert(frame.axes, d), 0};
    const Matrix vectors = diagonalize(squares);
    const Column values{squares[0][0], squares[1][1], squares[2][2]};
    if (*std::ranges::min_element(values) >= kLeastStretch * kLeastStretch) return {invert(frame.axes, d), 0};
    const Column x = solve_damped(columns, vectors, values, {d.x, d.y, d.z});
    Column rest{d.x, d.y, d.z};
    FrameCoordinates result;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t k = 0; k < 3; ++k) rest[k] -= columns[c][k] * x[c];
        if (frame.lengths[c] > 0) set_component(result.tbn, int(c), float(x[c] / double(frame.lengths[c])));
    }
    result.error = float(std::sqrt(dot(rest, rest)));
    return result;
}

} // namespace relief
