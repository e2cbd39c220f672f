#include "surface/mesh/uv_matching.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

constexpr int kSteps = 3; // of Newton's method
/// Places are at most this far outside of the quad, in parts of it: the neighbour's surface leaves the
/// continuation of the face's with the third power of the way.
constexpr double kFurthest = 0.1;

template <class Value> Value blend(const std::array<Value, 4>& c, double x, double y) {
    return (c[0] * (1 - x) + c[1] * x) * (1 - y) + (c[3] * (1 - x) + c[2] * x) * y;
}

} // namespace

Vec2<double> find_place_on_side(size_t k, double s) {
    return {k == 0 ? s : k == 1 ? 1 : k == 2 ? 1 - s : 0, k == 0 ? 0 : k == 1 ? s : k == 2 ? 1 : 1 - s};
}

double find_place_along_side(size_t k, const Vec2<double>& place) {
    return k == 0 ? place.x : k == 1 ? place.y : k == 2 ? 1 - place.x : 1 - place.y;
}

UvMatching::UvMatching(const LimitFace& uv_face, const QuadPlace& place, const std::array<Vec2f, 4>& uvs)
    : uv_face_(uv_face), place_(place) {
    for (size_t k = 0; k < 4; ++k) uvs_[k] = {uvs[k].x, uvs[k].y};
}

Vec2<double> UvMatching::interpolate(double x, double y) const { return blend(uvs_, x, y); }

UvMatching::Match UvMatching::evaluate(const Vec2<double>& at, const Vec2<double>& wanted) const {
    const std::array<Vec2<double>, 4>& c = place_.corners;
    const Vec2<double> on_face = blend(c, at.x, at.y);
    const Vec2<double> along_x = (c[1] - c[0]) * (1 - at.y) + (c[2] - c[3]) * at.y;
    const Vec2<double> along_y = (c[3] - c[0]) * (1 - at.x) + (c[2] - c[1]) * at.x;
    const LimitSample uv = uv_face_.evaluate(place_.part, on_face.x, on_face.y);
    const auto derive = [&](const Vec2<double>& way) {
        return Vec2<double>{uv.du.x * way.x + uv.dv.x * way.y, uv.du.y * way.x + uv.dv.y * way.y};
    };
    return {at, {wanted.x - uv.position.x, wanted.y - uv.position.y}, derive(along_x), derive(along_y)};
}

Vec2<double> UvMatching::measure_on_side(size_t k, double s, double place) const {
    const Vec2<double> at =
        blend(place_.corners, find_place_on_side(k, place).x, find_place_on_side(k, place).y);
    const Vec2<double> here = find_place_on_side(k, s), wanted = interpolate(here.x, here.y);
    const Vec3d uv = uv_face_.evaluate_position(place_.part, at.x, at.y);
    return {std::fabs(wanted.x - uv.x), std::fabs(wanted.y - uv.y)};
}

UvMatching::Match UvMatching::match(double x, double y) const {
    const Vec2<double> wanted = interpolate(x, y);
    const double margin = uv_face_.is_bicubic() ? kFurthest : 0;
    Match match = evaluate({x, y}, wanted);
    for (int step = 0; step < kSteps; ++step) {
        const double determinant = match.du.x * match.dv.y - match.du.y * match.dv.x;
        if (!(std::fabs(determinant) > 0)) break;
        const double dx = (match.error.x * match.dv.y - match.error.y * match.dv.x) / determinant;
        const double dy = (match.du.x * match.error.y - match.du.y * match.error.x) / determinant;
        const Vec2<double> next{std::clamp(match.place.x + dx, -margin, 1 + margin),
                                std::clamp(match.place.y + dy, -margin, 1 + margin)};
        if (std::fabs(next.x - match.place.x) + std::fabs(next.y - match.place.y) < 1e-6) break;
        match = evaluate(next, wanted);
    }
    match.error = {std::fabs(match.error.x), std::fabs(match.error.y)};
    return match;
}

UvMatching::Match UvMatching::match_on_side(size_t k, double s) const {
    const Vec2<double> begin = find_place_on_side(k, 0), end = find_place_on_side(k, 1), way = end - begin;
    const Vec2<double> here = find_place_on_side(k, s), wanted = interpolate(here.x, here.y);
    Match match = evaluate(here, wanted);
    double at = s;
    for (int step = 0; step < kSteps; ++step) {
        const Vec2<double> slope = match.du * way.x + match.dv * way.y;
        const double size = slope.x * slope.x + slope.y * slope.y;
        if (!(size > 0)) break;
        const double next =
            std::clamp(at + (match.error.x * slope.x + match.error.y * slope.y) / size, 0.0, 1.0);
        if (std::fabs(next - at) < 1e-6) break;
        at = next;
        match = evaluate(begin + way * at, wanted);
    }
    match.error = {std::fabs(match.error.x), std::fabs(match.error.y)};
    return match;
}

} // namespace relief
