// Least squares fits of cubic curves, and the weights that patches are fitted with.
#pragma once

#include <array>
#include <cstddef>

#include "math/vec_double.h"

namespace relief {

/// Samples per side of an edge or patch that is fitted.
inline constexpr int kFitCount = 5;
/// Most rounds of fitting and moving the samples' places.
inline constexpr int kFitPasses = 12;

inline double place_of_fit(int k) { return double(k + 1) / (kFitCount + 1); }

/// Bernstein polynomials of degree 3 at s, and their derivatives.
struct CubicWeights {
    std::array<double, 4> value, slope;

    explicit CubicWeights(double s) {
        const double r = 1 - s;
        value = {r * r * r, 3 * s * r * r, 3 * s * s * r, s * s * s};
        slope = {-3 * r * r, 3 * r * (r - 2 * s), 3 * s * (2 * r - s), 3 * s * s};
    }
};

/// Least squares for up to four points: the sum of weight[k] x[k] shall be `target`, over all rows added.
class PointFit {
  public:
    explicit PointFit(size_t count) : count_(count) {}

    void add(const std::array<double, 4>& weight, const Vec3d& target);
    /// By elimination: the matrix is positive definite where there are more rows than points.
    std::array<Vec3d, 4> solve();

  private:
    size_t count_;
    double matrix_[4][4] = {};
    std::array<Vec3d, 4> right_{};
};

using Curve = std::array<Vec3d, 4>; ///< control points of a cubic

using CurvePlaces = std::array<double, kFitCount>; ///< parameters of targets on a curve

/// Moves the inner control points so that the curve passes the targets, in order, at any parameters. With
/// `has_start` the curve is kept if it lies within `tolerance` of the targets; fits stop there, too. Returns
/// the parameters.
CurvePlaces fit_curve(Curve& curve, const std::array<Vec3d, kFitCount>& targets, bool has_start,
                      double tolerance);

/// Returns the largest distance of the targets from the curve. Moves each parameter by a Newton step towards
/// the foot of its target.
double project_on_curve(const Curve& curve, const std::array<Vec3d, kFitCount>& targets, CurvePlaces& place);

} // namespace relief
