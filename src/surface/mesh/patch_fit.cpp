#include "surface/mesh/patch_fit.h"

#include <algorithm>
#include <cmath>

#include "formulas/control_points.h"
#include "surface/mesh/curve_fit.h"

namespace relief {

namespace {

constexpr double kSmallestSine = 0.1;
constexpr double kNearby = 1.0 / 16; // of a quad
/// Distance that is as good as none, in parts of a patch's diagonal; and where errors are measured.
constexpr double kNegligible = 1e-6, kNegligibleIfMeasured = 5e-5;
/// Fits end when no sample moves by more, in parts of the patch.
constexpr double kSmallestMove = 1e-3;

} // namespace

PatchFit::PatchFit(const LimitFace& face, const RefinedMesh& refined, uint32_t quad)
    : face_(face), refined_(refined), quad_(quad), place_(refined.places[quad]) {
    for (size_t k = 0; k < 4; ++k) {
        is_regular_[k] = refined.is_regular[refined.points[quad][k]];
        const Vec2<double> to_next = side(k), to_previous = side((k + 3) % 4) * -1.0;
        const LimitSample sample =
            face_.evaluate_with_twist(place_.part, place_.corners[k].x, place_.corners[k].y);
        corner_[k] = sample.position;
        normal_[k] = find_normal(k, sample);
        to_next_[k] = sample.du * to_next.x + sample.dv * to_next.y;
        to_previous_[k] = sample.du * to_previous.x + sample.dv * to_previous.y;
        twist_[k] = sample.duv * (to_next.x * to_previous.y + to_next.y * to_previous.x);
    }
    is_in_bicubic_part_ = refined.is_adaptive && face_.is_bicubic_within(place_);
    const double size =
        std::max(compute_length(corner_[2] - corner_[0]), compute_length(corner_[3] - corner_[1]));
    negligible_ = (refined.is_adaptive ? kNegligibleIfMeasured : kNegligible) * size;
}

void PatchFit::fit() {
    for (size_t k = 0; k < 4; ++k) take_side(k, fit_side(k));
    fit_inside();
}

void PatchFit::take_side(size_t k, const SideFit& side) {
    const bool is_same_way = side.first_point == refined_.points[quad_][k];
    control_[2 * k] = side.inner[is_same_way ? 0 : 1], control_[2 * k + 1] = side.inner[is_same_way ? 1 : 0];
    distance_ = std::max(distance_, side.off);
    uv_error_ = {std::max(uv_error_.x, side.uv_error.x), std::max(uv_error_.y, side.uv_error.y)};
    has_exact_sides_ = has_exact_sides_ && !side.follows_uvs;
}

/// Whether the limit is a cubic along a side between regular points: only along the axes of a face.
bool PatchFit::is_cubic(size_t k) const {
    if (!is_along_axis(k)) return false;
    return refined_.is_adaptive ? is_in_bicubic_part_ : !refined_.is_bent[refined_.edges[quad_][k]];
}

bool PatchFit::has_exact_side(size_t k) const {
    return is_regular_[k] && is_regular_[(k + 1) % 4] && is_cubic(k);
}

bool PatchFit::is_exact() const {
    bool is_exact = has_exact_sides_;
    for (size_t k = 0; k < 4; ++k) is_exact = is_exact && has_exact_side(k);
    return is_exact;
}

Vec2<double> PatchFit::find_place(double x, double y) const {
    const std::array<Vec2<double>, 4>& c = place_.corners;
    return (c[0] * (1 - x) + c[1] * x) * (1 - y) + (c[3] * (1 - x) + c[2] * x) * y;
}

Vec3d PatchFit::evaluate(double x, double y) const {
    const Vec2<double> at = find_place(x, y);
    return face_.evaluate_position(place_.part, at.x, at.y);
}

Vec3d PatchFit::evaluate_edge(size_t k, double s) const {
    const double x = k == 0 ? s : k == 1 ? 1 : k == 2 ? 1 - s : 0;
    const double y = k == 0 ? 0 : k == 1 ? s : k == 2 ? 1 : 1 - s;
    return evaluate(x, y);
}

/// At corner k. Where a smooth boundary rounds a lone quad's corner, the normal is that of a place nearby.
Vec3d PatchFit::find_normal(size_t k, const LimitSample& sample) const {
    const Vec3d& exact = refined_.limit_normals[refined_.points[quad_][k]];
    if (!(exact == Vec3d{})) return exact;
    const Vec3d normal = cross(sample.du, sample.dv);
    const double product = std::sqrt(dot(sample.du, sample.du) * dot(sample.dv, sample.dv));
    if (is_regular_[k] || std::sqrt(dot(normal, normal)) > kSmallestSine * product)
        return normalize_double(normal);
    const Vec2<double> nearby =
        find_place(k == 1 || k == 2 ? 1 - kNearby : kNearby, k >= 2 ? 1 - kNearby : kNearby);
    const LimitSample inside = face_.evaluate(place_.part, nearby.x, nearby.y);
    return normalize_double(cross(inside.du, inside.dv));
}

/// Moves a control point beside corner k into the tangent plane, so that irregular patches join smoothly.
Vec3d PatchFit::flatten(const Vec3d& control, size_t k) const {
    return control - normal_[k] * dot(normal_[k], control - corner_[k]);
}

namespace {

/// Finds the place on the side that the curve passes at parameter s, by interpolation between the targets.
double find_place_of_parameter(const CurvePlaces& places, double s) {
    double parameter = 0, place = 0;
    for (int k = 0; k <= kFitCount; ++k) {
        const double next_parameter = k < kFitCount ? places[size_t(k)] : 1, next = place_of_fit(k);
        if (s <= next_parameter && next_parameter > parameter)
            return place + (next - place) * (s - parameter) / (next_parameter - parameter);
        parameter = next_parameter, place = next;
    }
    return 1;
}

} // namespace

/// Largest distance of the limit from the curve of a side, at many places near its ends: creases that wear
/// off and meet there bend it more than the samples of a fit show.
double PatchFit::measure_side(const Curve& curve, size_t k) const {
    constexpr CurvePlaces kPlaces[] = {
        {0.005, 0.015, 0.03, 0.06, 0.1}, {0.2, 0.35, 0.5, 0.65, 0.8}, {0.9, 0.94, 0.97, 0.985, 0.995}};
    double largest = 0;
    for (CurvePlaces places : kPlaces) {
        std::array<Vec3d, kFitCount> targets;
        for (size_t n = 0; n < places.size(); ++n) targets[n] = evaluate_edge(k, places[n]);
        project_on_curve(curve, targets, places);
        largest = std::max(largest, project_on_curve(curve, targets, places));
    }
    return largest;
}

SideFit PatchFit::start_side(size_t k) const {
    SideFit side;
    side.first_point = refined_.points[quad_][k];
    if (!refined_.uvs.empty()) side.uvs = {refined_.uvs[quad_][k], refined_.uvs[quad_][(k + 1) % 4]};
    return side;
}

SideFit PatchFit::fit_side(size_t k) {
    const size_t next = (k + 1) % 4;
    Curve curve = {corner_[k], corner_[k] + to_next_[k] * (1.0 / 3),
                   corner_[next] + to_previous_[next] * (1.0 / 3), corner_[next]};
    SideFit fit = start_side(k);
    for (size_t n = 0; n < kSideSamples; ++n) fit.places[n] = place_of_side_sample(n);
    if (!has_exact_side(k)) {
        std::array<Vec3d, kFitCount> targets;
        for (int sample = 0; sample < kFitCount; ++sample)
            targets[size_t(sample)] = evaluate_edge(k, place_of_fit(sample));
        const bool has_slopes = is_regular_[k] && is_regular_[next];
        CurvePlaces places = fit_curve(curve, targets, has_slopes && refined_.is_adaptive, negligible_);
        const bool is_sharp = refined_.is_sharp[refined_.edges[quad_][k]];
        if (!is_regular_[k] && !is_sharp) curve[1] = flatten(curve[1], k);
        if (!is_regular_[next] && !is_sharp) curve[2] = flatten(curve[2], next);
        fit.off = project_on_curve(curve, targets, places);
        if (face_.has_creases()) fit.off = std::max(fit.off, measure_side(curve, k));
        for (size_t n = 0; n < kSideSamples; ++n)
            fit.places[n] = find_place_of_parameter(places, place_of_side_sample(n));
    }
    fit.inner = {curve[1], curve[2]};
    return fit;
}

namespace {

double weigh_inner(size_t k, const CubicWeights& u, const CubicWeights& v) {
    return u.value[k == 1 || k == 2 ? 2 : 1] * v.value[k >= 2 ? 2 : 1];
}

} // namespace

void PatchFit::fit_inside() {
    for (size_t k = 0; k < 4; ++k)
        control_[8 + k] = corner_[k] + (to_next_[k] + to_previous_[k]) * (1.0 / 3) + twist_[k] * (1.0 / 9);
    if (is_exact()) return;
    std::array<Sample, 25> samples;
    for (int a = 0; a < kFitCount; ++a)
        for (int b = 0; b < kFitCount; ++b) {
            const double x = place_of_fit(a), y = place_of_fit(b);
            samples[size_t(a * kFitCount + b)] = {evaluate(x, y), x, y, x, y};
        }
    const bool has_slopes = is_regular_[0] && is_regular_[1] && is_regular_[2] && is_regular_[3];
    double distance = has_slopes && refined_.is_adaptive ? project_all(samples) : -1;
    if (distance < 0 || distance > negligible_) {
        // A start without derivatives at irregular points (Coons 1967, in control points).
        for (size_t k = 0; k < 4; ++k)
            control_[8 + k] = control_[2 * k] + control_[2 * ((k + 3) % 4) + 1] - corner_[k];
        for (Sample& sample : samples) sample.u = sample.x, sample.v = sample.y;
        for (int pass = 0; pass < kFitPasses; ++pass) {
            const std::array<Sample, 25> before = samples;
            distance = project_all(samples);
            if (pass > 0 && distance <= negligible_) break;
            double move = 0;
            for (size_t k = 0; k < samples.size(); ++k)
                move = std::max(
                    {move, std::fabs(samples[k].u - before[k].u), std::fabs(samples[k].v - before[k].v)});
            if (pass > 1 && move < kSmallestMove) break;
            solve_inside(samples);
        }
        distance = project_all(samples);
    }
    distance_ = std::max({distance_, distance, refined_.is_adaptive ? measure_beside_sides() : 0.0});
    for (const Sample& sample : samples)
        lag_ = std::max({lag_, std::fabs(sample.u - sample.x), std::fabs(sample.v - sample.y)});
}

/// Largest distance of the limit from the patch near its sides, where creases that wear off bend it more than
/// the samples show.
double PatchFit::measure_beside_sides() const {
    constexpr double kFew[] = {0.05, 0.35, 0.65, 0.95}, kNear[] = {0.03, 0.09};
    constexpr double kMany[] = {0.01, 0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95, 0.99},
                     kNearCreases[] = {0.01, 0.03, 0.06, 0.09, 0.13, 0.25};
    const std::span<const double> places = face_.has_creases() ? kMany : std::span<const double>(kFew),
                                  parts = face_.has_creases() ? kNearCreases : std::span<const double>(kNear);
    double largest = 0;
    for (size_t k = 0; k < 4; ++k)
        for (const double s : places) {
            const Vec2<double> on_side = find_place_on_side(k, s),
                               across = find_place_on_side((k + 2) % 4, 1 - s);
            for (const double part : parts) {
                const double x = on_side.x + (across.x - on_side.x) * part,
                             y = on_side.y + (across.y - on_side.y) * part;
                Sample sample{evaluate(x, y), x, y, x, y};
                project(sample);
                largest = std::max(largest, project(sample));
            }
        }
    return largest;
}

/// Moves all samples to the patch. Returns the largest distance.
double PatchFit::project_all(std::array<Sample, 25>& samples) {
    double largest = 0;
    for (Sample& sample : samples) largest = std::max(largest, project(sample));
    return largest;
}

/// Moves a sample by a Newton step towards the foot of its target on the patch (Hoschek 1988, Intrinsic
/// parametrization). Returns the distance of the target from the patch's tangent plane.
double PatchFit::project(Sample& sample) const {
    const CubicWeights u(sample.u), v(sample.v);
    Vec3d p{}, du{}, dv{};
    for (uint32_t column = 0; column < 4; ++column)
        for (uint32_t row = 0; row < 4; ++row) {
            const uint32_t k = scalar::find_control_point(column, row);
            const Vec3d& c = k < 4 ? corner_[k] : control_[k - 4];
            p = p + c * (u.value[column] * v.value[row]);
            du = du + c * (u.slope[column] * v.value[row]);
            dv = dv + c * (u.value[column] * v.slope[row]);
        }
    const Vec3d miss = sample.target - p;
    const double uu = dot(du, du), uv = dot(du, dv), vv = dot(dv, dv), determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-6 * uu * vv)) return compute_length(miss);
    const double a = dot(miss, du), b = dot(miss, dv);
    sample.u = std::clamp(sample.u + (a * vv - b * uv) / determinant, 0.0, 1.0);
    sample.v = std::clamp(sample.v + (b * uu - a * uv) / determinant, 0.0, 1.0);
    return std::fabs(dot(miss, cross(du, dv))) / std::sqrt(determinant);
}

/// The inner control points that come nearest to the targets at the samples' places on the patch.
void PatchFit::solve_inside(std::span<const Sample> samples) {
    for (size_t k = 0; k < 4; ++k) control_[8 + k] = {};
    PointFit fit(4);
    for (const Sample& sample : samples) {
        const CubicWeights u(sample.u), v(sample.v);
        Vec3d rest = sample.target;
        std::array<double, 4> weights{};
        for (uint32_t column = 0; column < 4; ++column)
            for (uint32_t row = 0; row < 4; ++row) {
                const uint32_t k = scalar::find_control_point(column, row);
                if (k < 12)
                    rest = rest - (k < 4 ? corner_[k] : control_[k - 4]) * (u.value[column] * v.value[row]);
            }
        for (size_t k = 0; k < 4; ++k) weights[k] = weigh_inner(k, u, v);
        fit.add(weights, rest);
    }
    const std::array<Vec3d, 4> found = fit.solve();
    for (size_t k = 0; k < 4; ++k) control_[8 + k] = found[k];
}

} // namespace relief
