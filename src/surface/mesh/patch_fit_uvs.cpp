// Patches whose parameters follow uvs: least squares at places that are found beforehand.
#include <algorithm>
#include <cmath>

#include "formulas/control_points.h"
#include "surface/mesh/curve_fit.h"
#include "surface/mesh/patch_fit.h"

namespace relief {

namespace {

constexpr size_t kInnerCount = 3; // samples per direction

double place_of_inner_sample(size_t k) { return double(k + 1) / (kInnerCount + 1); }

} // namespace

/// Adds what a miss of the limit surface comes to: at right angles to it, and in uvs along it.
void PatchFit::add_miss(const UvMatching::Match& match, const Vec3d& miss, Misses& misses) const {
    const Vec2<double> at = find_place(match.place.x, match.place.y);
    const LimitSample sample = face_.evaluate(place_.part, at.x, at.y);
    const std::array<Vec2<double>, 4>& c = place_.corners;
    const Vec2<double> along_x = (c[1] - c[0]) * (1 - match.place.y) + (c[2] - c[3]) * match.place.y;
    const Vec2<double> along_y = (c[3] - c[0]) * (1 - match.place.x) + (c[2] - c[1]) * match.place.x;
    const Vec3d dx = sample.du * along_x.x + sample.dv * along_x.y,
                dy = sample.du * along_y.x + sample.dv * along_y.y;
    const double xx = dot(dx, dx), xy = dot(dx, dy), yy = dot(dy, dy), determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-6 * xx * yy)) {
        misses.off = std::max(misses.off, compute_length(miss));
        return;
    }
    misses.off = std::max(misses.off, std::fabs(dot(miss, cross(dx, dy))) / std::sqrt(determinant));
    const double a = dot(miss, dx), b = dot(miss, dy);
    const double x = (a * yy - b * xy) / determinant, y = (b * xx - a * xy) / determinant;
    misses.uv_error.x =
        std::max(misses.uv_error.x, match.error.x + std::fabs(match.du.x * x + match.dv.x * y));
    misses.uv_error.y =
        std::max(misses.uv_error.y, match.error.y + std::fabs(match.du.y * x + match.dv.y * y));
}

SideFit PatchFit::fit_side_to_uvs(size_t k, const UvMatching& uvs, bool may_leave_side) {
    const size_t next = (k + 1) % 4;
    std::array<UvMatching::Match, kSideSamples> matches;
    std::array<Vec3d, kSideSamples> targets;
    PointFit fit(2);
    SideFit side = start_side(k);
    side.follows_uvs = true;
    for (size_t n = 0; n < kSideSamples; ++n) {
        const double s = place_of_side_sample(n);
        const Vec2<double> place = find_place_on_side(k, s);
        matches[n] = may_leave_side ? uvs.match(place.x, place.y) : uvs.match_on_side(k, s);
        side.places[n] = find_place_along_side(k, matches[n].place);
        targets[n] = evaluate(matches[n].place.x, matches[n].place.y);
        const std::array<double, 4> w = CubicWeights(s).value;
        fit.add({w[1], w[2]}, targets[n] - corner_[k] * w[0] - corner_[next] * w[3]);
    }
    std::array<Vec3d, 4> inner = fit.solve();
    const bool is_sharp = refined_.is_sharp[refined_.edges[quad_][k]];
    if (!is_regular_[k] && !is_sharp) inner[0] = flatten(inner[0], k);
    if (!is_regular_[next] && !is_sharp) inner[1] = flatten(inner[1], next);
    side.inner = {inner[0], inner[1]};
    Misses misses;
    for (size_t n = 0; n < kSideSamples; ++n) {
        const std::array<double, 4> w = CubicWeights(place_of_side_sample(n)).value;
        add_miss(matches[n],
                 corner_[k] * w[0] + inner[0] * w[1] + inner[1] * w[2] + corner_[next] * w[3] - targets[n],
                 misses);
    }
    side.off = misses.off, side.uv_error = misses.uv_error;
    if (face_.has_creases())
        side.off = std::max(side.off, measure_side({corner_[k], inner[0], inner[1], corner_[next]}, k));
    return side;
}

void PatchFit::fit_inside_to_uvs(const UvMatching& uvs) {
    std::array<UvMatching::Match, kInnerCount * kInnerCount> matches;
    std::array<Sample, kInnerCount * kInnerCount> samples;
    for (size_t a = 0; a < kInnerCount; ++a)
        for (size_t b = 0; b < kInnerCount; ++b) {
            const double x = place_of_inner_sample(a), y = place_of_inner_sample(b);
            const size_t k = a * kInnerCount + b;
            matches[k] = uvs.match(x, y);
            samples[k] = {evaluate(matches[k].place.x, matches[k].place.y), x, y, x, y};
        }
    solve_inside(samples);
    Misses misses{distance_, uv_error_};
    for (size_t k = 0; k < samples.size(); ++k)
        add_miss(matches[k], blend(samples[k].x, samples[k].y) - samples[k].target, misses);
    distance_ = misses.off, uv_error_ = misses.uv_error;
    if (face_.has_creases()) distance_ = std::max(distance_, measure_beside_sides());
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
