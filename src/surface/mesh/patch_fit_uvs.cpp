// Patches whose parameters follow uvs: least squares at places that are found beforehand.
#include <algorithm>
#include <cmath>

#include "formulas/control_points.h"
#include "surface/mesh/curve_fit.h"
#include "surface/mesh/patch_fit.h"

namespace relief {

namespace {

constexpr int kInnerCount = 3, kEdgeCount = 3; // samples per direction

double place_of(int k, int count) { return double(k + 1) / (count + 1); }

} // namespace

void PatchFit::fit_to_uvs(const LimitFace& uv_face, const std::array<Vec2f, 4>& uvs) {
    distance_ = lag_ = 0, uv_error_ = {};
    const UvMatching matching(uv_face, place_, uvs);
    const bool is_bicubic = face_.is_bicubic() && uv_face.is_bicubic();
    for (size_t k = 0; k < 4; ++k)
        fit_edge_to_uvs(k, matching, is_bicubic && !refined_.is_sharp[refined_.edges[quad_][k]]);
    fit_inside_to_uvs(matching);
}

/// Adds what a miss of the limit surface comes to: at right angles to it, and in uvs along it.
void PatchFit::add_uv_error(const UvMatching::Match& match, const Vec3d& miss) {
    const Vec2<double> at = find_place(match.place.x, match.place.y);
    const LimitSample sample = face_.evaluate(place_.part, at.x, at.y);
    const std::array<Vec2<double>, 4>& c = place_.corners;
    const Vec2<double> along_x = (c[1] - c[0]) * (1 - match.place.y) + (c[2] - c[3]) * match.place.y;
    const Vec2<double> along_y = (c[3] - c[0]) * (1 - match.place.x) + (c[2] - c[1]) * match.place.x;
    const Vec3d dx = sample.du * along_x.x + sample.dv * along_x.y,
                dy = sample.du * along_y.x + sample.dv * along_y.y;
    const double xx = dot(dx, dx), xy = dot(dx, dy), yy = dot(dy, dy), determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-6 * xx * yy)) {
        distance_ = std::max(distance_, compute_length(miss));
        return;
    }
    distance_ = std::max(distance_, std::fabs(dot(miss, cross(dx, dy))) / std::sqrt(determinant));
    const double a = dot(miss, dx), b = dot(miss, dy);
    const double x = (a * yy - b * xy) / determinant, y = (b * xx - a * xy) / determinant;
    uv_error_.x = std::max(uv_error_.x, match.error.x + std::fabs(match.du.x * x + match.dv.x * y));
    uv_error_.y = std::max(uv_error_.y, match.error.y + std::fabs(match.du.y * x + match.dv.y * y));
}

void PatchFit::fit_edge_to_uvs(size_t k, const UvMatching& uvs, bool may_leave_face) {
    const size_t next = (k + 1) % 4;
    std::array<UvMatching::Match, kEdgeCount> matches;
    std::array<Vec3d, kEdgeCount> targets;
    PointFit fit(2);
    for (int n = 0; n < kEdgeCount; ++n) {
        const double s = place_of(n, kEdgeCount);
        const Vec2<double> place = find_place_on_side(k, s);
        UvMatching::Match& match = matches[size_t(n)];
        match = may_leave_face ? uvs.match(place.x, place.y) : uvs.match_on_side(k, s);
        targets[size_t(n)] = evaluate(match.place.x, match.place.y);
        const std::array<double, 4> w = CubicWeights(s).value;
        fit.add({w[1], w[2]}, targets[size_t(n)] - corner_[k] * w[0] - corner_[next] * w[3]);
    }
    std::array<Vec3d, 4> inner = fit.solve();
    const bool is_sharp = refined_.is_sharp[refined_.edges[quad_][k]];
    if (!is_regular_[k] && !is_sharp) inner[0] = flatten(inner[0], k);
    if (!is_regular_[next] && !is_sharp) inner[1] = flatten(inner[1], next);
    control_[2 * k] = inner[0], control_[2 * k + 1] = inner[1];
    for (int n = 0; n < kEdgeCount; ++n) {
        const std::array<double, 4> w = CubicWeights(place_of(n, kEdgeCount)).value;
        add_uv_error(matches[size_t(n)], corner_[k] * w[0] + inner[0] * w[1] + inner[1] * w[2] +
                                             corner_[next] * w[3] - targets[size_t(n)]);
    }
}

void PatchFit::fit_inside_to_uvs(const UvMatching& uvs) {
    std::array<UvMatching::Match, kInnerCount * kInnerCount> matches;
    std::array<Sample, kInnerCount * kInnerCount> samples;
    for (int a = 0; a < kInnerCount; ++a)
        for (int b = 0; b < kInnerCount; ++b) {
            const double x = place_of(a, kInnerCount), y = place_of(b, kInnerCount);
            const size_t k = size_t(a * kInnerCount + b);
            matches[k] = uvs.match(x, y);
            samples[k] = {evaluate(matches[k].place.x, matches[k].place.y), x, y, x, y};
        }
    solve_inside(samples);
    for (size_t k = 0; k < samples.size(); ++k)
        add_uv_error(matches[k], blend(samples[k].x, samples[k].y) - samples[k].target);
}

Vec3d PatchFit::blend(double x, double y) const {
    const CubicWeights u(x), v(y);
    Vec3d p{};
    for (uint32_t column = 0; column < 4; ++column)
        for (uint32_t row = 0; row < 4; ++row) {
            const uint32_t k = scalar::find_control_point(column, row);
            p = p + (k < 4 ? corner_[k] : control_[k - 4]) * (u.value[column] * v.value[row]);
        }
    return p;
}

} // namespace relief
