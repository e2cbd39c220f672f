#include "surface/mesh/curve_fit.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// Fits end when no place moves by more.
constexpr double kSmallestMove = 1e-4;

/// Parameters in proportion to the length of the way from target to target.
CurvePlaces measure_way(const Curve& curve, const std::array<Vec3d, kFitCount>& targets) {
    CurvePlaces place;
    double way = 0;
    for (size_t k = 0; k < targets.size(); ++k)
        place[k] = way += compute_length(targets[k] - (k == 0 ? curve[0] : targets[k - 1]));
    way += compute_length(curve[3] - targets.back());
    for (double& s : place) s = way > 0 ? s / way : 0.5;
    return place;
}

struct Projection {
    double distance = 0, move = 0;
};

/// Moves each place by a Newton step towards the foot of its target on the curve.
Projection project(const Curve& curve, const std::array<Vec3d, kFitCount>& targets, CurvePlaces& place) {
    Projection projection;
    for (size_t k = 0; k < targets.size(); ++k) {
        const CubicWeights w(place[k]);
        Vec3d p{}, slope{};
        for (size_t c = 0; c < 4; ++c) p = p + curve[c] * w.value[c], slope = slope + curve[c] * w.slope[c];
        const Vec3d miss = targets[k] - p;
        const double size = dot(slope, slope), along = dot(miss, slope);
        if (!(size > 0)) {
            projection.distance = std::max(projection.distance, compute_length(miss));
            continue;
        }
        const double moved = std::clamp(place[k] + along / size, 0.0, 1.0);
        projection.move = std::max(projection.move, std::fabs(moved - place[k]));
        projection.distance = std::max(projection.distance, compute_length(miss - slope * (along / size)));
        place[k] = moved;
    }
    return projection;
}

void solve(Curve& curve, const std::array<Vec3d, kFitCount>& targets, const CurvePlaces& place) {
    PointFit fit(2);
    for (size_t k = 0; k < targets.size(); ++k) {
        const std::array<double, 4> w = CubicWeights(place[k]).value;
        fit.add({w[1], w[2]}, targets[k] - curve[0] * w[0] - curve[3] * w[3]);
    }
    const std::array<Vec3d, 4> found = fit.solve();
    curve[1] = found[0], curve[2] = found[1];
}

} // namespace

void PointFit::add(const std::array<double, 4>& weight, const Vec3d& target) {
    for (size_t a = 0; a < count_; ++a) {
        for (size_t b = 0; b < count_; ++b) matrix_[a][b] += weight[a] * weight[b];
        right_[a] += target * weight[a];
    }
}

std::array<Vec3d, 4> PointFit::solve() {
    for (size_t k = 0; k < count_; ++k)
        for (size_t row = k + 1; row < count_; ++row) {
            const double factor = matrix_[row][k] / matrix_[k][k];
            for (size_t column = k; column < count_; ++column)
                matrix_[row][column] -= factor * matrix_[k][column];
            right_[row] = right_[row] - right_[k] * factor;
        }
    std::array<Vec3d, 4> x{};
    for (size_t k = count_; k-- > 0;) {
        Vec3d sum = right_[k];
        for (size_t column = k + 1; column < count_; ++column) sum = sum - x[column] * matrix_[k][column];
        x[k] = sum * (1 / matrix_[k][k]);
    }
    return x;
}

CurvePlaces fit_curve(Curve& curve, const std::array<Vec3d, kFitCount>& targets, bool has_start,
                      double tolerance) {
    CurvePlaces even;
    for (int k = 0; k < kFitCount; ++k) even[size_t(k)] = place_of_fit(k);
    if (has_start) {
        CurvePlaces place = even;
        if (project(curve, targets, place).distance <= tolerance) return place;
    }
    if (curve[0] == curve[3] && std::ranges::all_of(targets, [&](const Vec3d& p) { return p == curve[0]; })) {
        curve[1] = curve[2] = curve[0];
        return even;
    }
    CurvePlaces place = measure_way(curve, targets);
    Projection projection;
    for (int pass = 0; pass < kFitPasses; ++pass) {
        solve(curve, targets, place);
        projection = project(curve, targets, place);
        if (projection.distance <= tolerance || projection.move < kSmallestMove) break;
    }
    return place;
}

double project_on_curve(const Curve& curve, const std::array<Vec3d, kFitCount>& targets, CurvePlaces& place) {
    return project(curve, targets, place).distance;
}

} // namespace relief
