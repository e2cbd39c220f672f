#include "surface/mesh/limit_face.h"

#include <algorithm>
#include <cmath>

#include "surface/mesh/subdivision_topology.h"

namespace relief {

LimitFace::LimitFace(std::shared_ptr<const Surface> surface, uint32_t irregular_corners,
                     bool is_bicubic_apart)
    : surface_(std::move(surface)),
      irregular_corners_(irregular_corners),
      is_bicubic_apart_(is_bicubic_apart) {}
LimitFace::LimitFace(const SplineControls& controls) : controls_(controls) {}
LimitFace::~LimitFace() = default;
LimitFace::LimitFace(LimitFace&&) noexcept = default;

/// After one step of subdivision all cells of a face are regular except those at its irregular corners,
/// after d steps with cells of 2^-d: the rectangle must lie in such a cell, and not at an irregular corner.
bool LimitFace::is_bicubic_within(const QuadPlace& quad) const {
    if (is_bicubic()) return true;
    if (!is_bicubic_apart_) return false;
    Vec2<double> low = quad.corners[0], high = low;
    for (const Vec2<double>& corner : quad.corners) {
        low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
        high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
    }
    constexpr int kMostSteps = 12;
    for (int step = 1; step <= kMostSteps; ++step) {
        const double side = std::ldexp(1.0, -step);
        const double i = std::floor(low.x / side), j = std::floor(low.y / side);
        if (high.x > (i + 1) * side || high.y > (j + 1) * side) return false;
        const double last = std::ldexp(1.0, step) - 1;
        const uint32_t corner = j == 0      ? (i == 0      ? 1u
                                               : i == last ? 2u
                                                           : 0u)
                                : j == last ? (i == last ? 4u
                                               : i == 0  ? 8u
                                                         : 0u)
                                            : 0u;
        if ((irregular_corners_ & corner) == 0) return true;
    }
    return false;
}

bool LimitFace::has_cells() const { return !surface_->cells.empty(); }

const LimitCells& LimitFace::cells_of(uint32_t part) const {
    return surface_->cells[surface_->cells.size() == 1 ? 0 : part];
}

/// Finds the place of (u, v) in OpenSubdiv's parameters. Returns the size of a part in them.
double LimitFace::find_place(uint32_t part, double u, double v, double (&place)[2]) const {
    place[0] = u, place[1] = v;
    if (!surface_->parameters.HasSubFaces()) return 1;
    const double in_part[2] = {u, v};
    surface_->parameters.ConvertNormalizedSubFaceToCoord(int(part), in_part, place);
    return 0.5;
}

Vec3d LimitFace::evaluate_position(uint32_t part, double u, double v) const {
    if (!surface_) return evaluate_spline_position(controls_, u, v);
    if (has_cells()) return cells_of(part).evaluate_position(u, v);
    double place[2], p[3];
    find_place(part, u, v, place);
    surface_->surface.Evaluate(place, surface_->points.data(), 3, p);
    return read(p);
}

LimitSample LimitFace::evaluate(uint32_t part, double u, double v) const {
    if (!surface_) return evaluate_spline(controls_, u, v, false);
    if (has_cells()) return cells_of(part).evaluate(u, v, false);
    double place[2], p[3], du[3], dv[3];
    const double scale = find_place(part, u, v, place);
    surface_->surface.Evaluate(place, surface_->points.data(), 3, p, du, dv);
    return {read(p), read(du) * scale, read(dv) * scale};
}

LimitSample LimitFace::evaluate_with_twist(uint32_t part, double u, double v) const {
    if (!surface_) return evaluate_spline(controls_, u, v, true);
    if (has_cells()) return cells_of(part).evaluate(u, v, true);
    double place[2], p[3], du[3], dv[3], duu[3], duv[3], dvv[3];
    const double scale = find_place(part, u, v, place);
    surface_->surface.Evaluate(place, surface_->points.data(), 3, p, du, dv, duu, duv, dvv);
    return {read(p), read(du) * scale, read(dv) * scale, read(duv) * (scale * scale)};
}

} // namespace relief
