#include "surface/mesh/limit_patches.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "formulas/control_points.h"

namespace relief {

namespace {

/// Samples a side of an edge or patch that is fitted.
constexpr int kFitCount = 5;
/// Rounds of fitting and moving the samples' places.
constexpr int kFitPasses = 12;
constexpr double kSmallestSine = 0.1;
constexpr double kNearby = 1.0 / 16; // of a cell

/// Bernstein polynomials of degree 3.
std::array<double, 4> weigh(double s) {
    const double r = 1 - s;
    return {r * r * r, 3 * s * r * r, 3 * s * s * r, s * s * s};
}

double place_of_fit(int k) { return double(k + 1) / (kFitCount + 1); }

/// Least squares for up to four points: the sum of weight[k] x[k] shall be `target`, over all rows added.
class PointFit {
  public:
    explicit PointFit(size_t count) : count_(count) {}

    void add(const std::array<double, 4>& weight, const Vec3d& target) {
        for (size_t a = 0; a < count_; ++a) {
            for (size_t b = 0; b < count_; ++b) matrix_[a][b] += weight[a] * weight[b];
            right_[a] += target * weight[a];
        }
    }

    /// By elimination: the matrix is positive definite where there are more rows than points.
    std::array<Vec3d, 4> solve() {
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

  private:
    size_t count_;
    double matrix_[4][4] = {};
    std::array<Vec3d, 4> right_{};
};

using Curve = std::array<Vec3d, 4>;

Vec3d blend_curve(const Curve& c, double s) {
    const std::array<double, 4> w = weigh(s);
    return c[0] * w[0] + c[1] * w[1] + c[2] * w[2] + c[3] * w[3];
}

/// Moves the inner control points so that the curve passes the targets, in order, at any parameters.
void fit_curve(Curve& curve, const std::array<Vec3d, kFitCount>& targets) {
    std::array<double, kFitCount> place;
    double way = 0;
    for (size_t k = 0; k < targets.size(); ++k) {
        const Vec3d step = targets[k] - (k == 0 ? curve[0] : targets[k - 1]);
        place[k] = way += std::sqrt(dot(step, step));
    }
    const Vec3d last = curve[3] - targets.back();
    way += std::sqrt(dot(last, last));
    for (double& s : place) s = way > 0 ? s / way : 0.5;
    for (int pass = 0; pass < kFitPasses; ++pass) {
        PointFit fit(2);
        for (size_t k = 0; k < targets.size(); ++k) {
            const std::array<double, 4> w = weigh(place[k]);
            fit.add({w[1], w[2]}, targets[k] - curve[0] * w[0] - curve[3] * w[3]);
        }
        const std::array<Vec3d, 4> found = fit.solve();
        curve[1] = found[0], curve[2] = found[1];
        for (size_t k = 0; k < targets.size(); ++k) {
            const std::array<double, 3> q = {(1 - place[k]) * (1 - place[k]), 2 * place[k] * (1 - place[k]),
                                             place[k] * place[k]};
            const Vec3d slope =
                ((curve[1] - curve[0]) * q[0] + (curve[2] - curve[1]) * q[1] + (curve[3] - curve[2]) * q[2]) *
                3.0;
            const double size = dot(slope, slope);
            if (size > 0)
                place[k] = std::clamp(place[k] + dot(targets[k] - blend_curve(curve, place[k]), slope) / size,
                                      0.0, 1.0);
        }
    }
}

struct FitSample {
    Vec3d target;
    double u = 0, v = 0;
};

/// One quad of the refined mesh on the limit surface of its face; derivatives are by the quad's parameters.
class Cell {
  public:
    Cell(const LimitFace& face, const RefinedMesh& refined, uint32_t quad)
        : face_(face), refined_(refined), quad_(quad), place_(refined.places[quad]) {
        for (size_t k = 0; k < 4; ++k) {
            is_regular_[k] = refined.is_regular[refined.points[quad][k]];
            const Vec2<double> to_next = side(k), to_previous = side((k + 3) % 4) * -1.0;
            const LimitSample sample = face_.evaluate(place_.part, place_.corners[k].x, place_.corners[k].y);
            corner_[k] = sample.position;
            normal_[k] = find_normal(k, sample);
            to_next_[k] = sample.du * to_next.x + sample.dv * to_next.y;
            to_previous_[k] = sample.du * to_previous.x + sample.dv * to_previous.y;
            twist_[k] = sample.duv * (to_next.x * to_previous.y + to_next.y * to_previous.x);
        }
    }

    void fit() {
        for (size_t k = 0; k < 4; ++k) fit_edge(k);
        fit_inside();
    }

    const Vec3d& corner(size_t k) const { return corner_[k]; }
    const Vec3d& normal(size_t k) const { return normal_[k]; }
    /// In the order of InnerControls; once fitted.
    const Vec3d& control(size_t k) const { return control_[k]; }

  private:
    /// Side k in the parameters of the face.
    Vec2<double> side(size_t k) const { return place_.corners[(k + 1) % 4] - place_.corners[k]; }
    /// Of a side between regular points: only along the axes of a face its surface is cubic.
    bool is_cubic(size_t k) const {
        return (side(k).x == 0 || side(k).y == 0) && !refined_.is_bent[refined_.edges[quad_][k]];
    }

    LimitSample evaluate(double x, double y) const {
        const std::array<Vec2<double>, 4>& c = place_.corners;
        const Vec2<double> at = (c[0] * (1 - x) + c[1] * x) * (1 - y) + (c[3] * (1 - x) + c[2] * x) * y;
        return face_.evaluate(place_.part, at.x, at.y);
    }

    /// At corner k. Where a smooth boundary rounds a lone quad's corner, the normal is that of a place
    /// nearby.
    Vec3d find_normal(size_t k, const LimitSample& sample) const {
        const Vec3d& exact = refined_.limit_normals[refined_.points[quad_][k]];
        if (!(exact == Vec3d{})) return exact;
        const Vec3d normal = cross(sample.du, sample.dv);
        const double product = std::sqrt(dot(sample.du, sample.du) * dot(sample.dv, sample.dv));
        if (is_regular_[k] || std::sqrt(dot(normal, normal)) > kSmallestSine * product)
            return normalize_double(normal);
        const LimitSample inside =
            evaluate(k == 1 || k == 2 ? 1 - kNearby : kNearby, k >= 2 ? 1 - kNearby : kNearby);
        return normalize_double(cross(inside.du, inside.dv));
    }

    /// Moves a control point beside corner k into the tangent plane, so that irregular patches join smoothly.
    Vec3d flatten(const Vec3d& control, size_t k) const {
        return control - normal_[k] * dot(normal_[k], control - corner_[k]);
    }

    void fit_edge(size_t k) {
        const size_t next = (k + 1) % 4;
        Curve curve = {corner_[k], corner_[k] + to_next_[k] * (1.0 / 3),
                       corner_[next] + to_previous_[next] * (1.0 / 3), corner_[next]};
        if (!is_regular_[k] || !is_regular_[next] || !is_cubic(k)) {
            std::array<Vec3d, kFitCount> targets;
            for (int sample = 0; sample < kFitCount; ++sample)
                targets[size_t(sample)] = evaluate_edge(k, place_of_fit(sample));
            fit_curve(curve, targets);
            const bool is_sharp = refined_.is_sharp[refined_.edges[quad_][k]];
            if (!is_regular_[k] && !is_sharp) curve[1] = flatten(curve[1], k);
            if (!is_regular_[next] && !is_sharp) curve[2] = flatten(curve[2], next);
        }
        control_[2 * k] = curve[1], control_[2 * k + 1] = curve[2];
    }

    Vec3d evaluate_edge(size_t k, double s) const {
        const double x = k == 0 ? s : k == 1 ? 1 : k == 2 ? 1 - s : 0;
        const double y = k == 0 ? 0 : k == 1 ? s : k == 2 ? 1 : 1 - s;
        return evaluate(x, y).position;
    }

    void fit_inside() {
        for (size_t k = 0; k < 4; ++k)
            control_[8 + k] =
                corner_[k] + (to_next_[k] + to_previous_[k]) * (1.0 / 3) + twist_[k] * (1.0 / 9);
        bool is_exact = true;
        for (size_t k = 0; k < 4; ++k) is_exact = is_exact && is_regular_[k] && is_cubic(k);
        if (is_exact) return;
        // A start without derivatives at irregular points (Coons 1967, in control points).
        for (size_t k = 0; k < 4; ++k)
            control_[8 + k] = control_[2 * k] + control_[2 * ((k + 3) % 4) + 1] - corner_[k];
        std::array<FitSample, kFitCount * kFitCount> samples;
        for (int a = 0; a < kFitCount; ++a)
            for (int b = 0; b < kFitCount; ++b) {
                const double u = place_of_fit(a), v = place_of_fit(b);
                samples[size_t(a * kFitCount + b)] = {evaluate(u, v).position, u, v};
            }
        for (int pass = 0; pass < kFitPasses; ++pass) {
            for (FitSample& sample : samples) project(sample);
            for (size_t k = 0; k < 4; ++k) control_[8 + k] = {};
            PointFit fit(4);
            for (const FitSample& sample : samples) {
                std::array<double, 4> weights{};
                for (size_t k = 0; k < 4; ++k) weights[k] = weigh_inner(k, sample.u, sample.v);
                fit.add(weights, sample.target - blend(sample.u, sample.v));
            }
            const std::array<Vec3d, 4> found = fit.solve();
            for (size_t k = 0; k < 4; ++k) control_[8 + k] = found[k];
        }
    }

    /// Newton step to the foot of a sample's target on the patch (Hoschek 1988, Intrinsic parametrization).
    void project(FitSample& sample) const {
        constexpr double kStep = 1e-4;
        const Vec3d p = blend(sample.u, sample.v), miss = sample.target - p;
        const Vec3d du = (blend(sample.u + kStep, sample.v) - p) * (1 / kStep);
        const Vec3d dv = (blend(sample.u, sample.v + kStep) - p) * (1 / kStep);
        const double uu = dot(du, du), uv = dot(du, dv), vv = dot(dv, dv), determinant = uu * vv - uv * uv;
        if (!(determinant > 1e-6 * uu * vv)) return;
        const double a = dot(miss, du), b = dot(miss, dv);
        sample.u = std::clamp(sample.u + (a * vv - b * uv) / determinant, 0.0, 1.0);
        sample.v = std::clamp(sample.v + (b * uu - a * uv) / determinant, 0.0, 1.0);
    }

    static double weigh_inner(size_t k, double u, double v) {
        return weigh(u)[k == 1 || k == 2 ? 2 : 1] * weigh(v)[k >= 2 ? 2 : 1];
    }

    Vec3d blend(double u, double v) const {
        const std::array<double, 4> wu = weigh(u), wv = weigh(v);
        Vec3d sum{};
        for (uint32_t column = 0; column < 4; ++column)
            for (uint32_t row = 0; row < 4; ++row) {
                const uint32_t k = scalar::find_control_point(column, row);
                sum = sum + (k < 4 ? corner_[k] : control_[k - 4]) * (wu[column] * wv[row]);
            }
        return sum;
    }

    const LimitFace& face_;
    const RefinedMesh& refined_;
    uint32_t quad_;
    const QuadPlace& place_;
    std::array<bool, 4> is_regular_{};
    std::array<Vec3d, 4> corner_{}, normal_{}, to_next_{}, to_previous_{}, twist_{};
    std::array<Vec3d, 12> control_{};
};

/// Lowest quad at each point, which says where the point is.
std::vector<uint32_t> find_first_quads(const RefinedMesh& refined) {
    std::vector<uint32_t> first(refined.point_count, kNoIndex);
    for (uint32_t quad = refined.quad_count(); quad-- > 0;)
        for (const uint32_t point : refined.points[quad]) first[point] = quad;
    return first;
}

/// Gives the sides of a quad to all others that share them.
void share_edges(const RefinedMesh& refined, std::vector<InnerControls>& controls) {
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        for (size_t k = 0; k < 4; ++k) {
            const uint32_t edge = refined.edges[quad][k], owner = refined.first_quads[edge];
            if (owner == quad) continue;
            const std::array<uint32_t, 4>& edges = refined.edges[owner];
            const size_t other = size_t(std::find(edges.begin(), edges.end(), edge) - edges.begin());
            const bool is_same_way = refined.points[owner][other] == refined.points[quad][k];
            controls[quad][2 * k] = controls[owner][2 * other + (is_same_way ? 0 : 1)];
            controls[quad][2 * k + 1] = controls[owner][2 * other + (is_same_way ? 1 : 0)];
        }
}

} // namespace

LimitPatches make_limit_patches(const SubdivisionMesh& mesh, const RefinedMesh& refined, bool has_controls) {
    LimitPatches patches;
    patches.positions.resize(refined.point_count);
    if (has_controls) patches.controls.resize(refined.quad_count());
    patches.corner_normals.resize(refined.quad_count());
    const std::vector<uint32_t> first_quads = find_first_quads(refined);
    std::vector<uint32_t> starts;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        if (quad == 0 || refined.places[quad].face != refined.places[quad - 1].face) starts.push_back(quad);
    starts.push_back(refined.quad_count());
    parallel_for("limit patches", starts.size() - 1, 16, [&](size_t begin, size_t end) {
        for (size_t run = begin; run < end; ++run) {
            const LimitFace face = mesh.make_face(refined.places[starts[run]].face);
            for (uint32_t quad = starts[run]; quad < starts[run + 1]; ++quad) {
                Cell cell(face, refined, quad);
                for (size_t k = 0; k < 4; ++k) {
                    const uint32_t point = refined.points[quad][k];
                    if (first_quads[point] == quad) patches.positions[point] = to_float(cell.corner(k));
                    patches.corner_normals[quad][k] = to_float(cell.normal(k));
                }
                if (!has_controls) continue;
                cell.fit();
                for (size_t k = 0; k < 12; ++k) patches.controls[quad][k] = to_float(cell.control(k));
            }
        }
    });
    if (has_controls) share_edges(refined, patches.controls);
    return patches;
}

} // namespace relief
