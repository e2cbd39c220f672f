#include "surface/mesh/patch_judge.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace relief {

namespace {

/// A cause of error is acted on from this part of the tolerance on.
constexpr double kSmallestCause = 0.25;

double measure(const Vec2<double>& way) { return std::max(std::fabs(way.x), std::fabs(way.y)); }

bool has_curved_uvs(const FaceBend& bend) {
    constexpr double kStraight = 1e-7;
    return std::max({bend.uv[0].x, bend.uv[0].y, bend.uv[1].x, bend.uv[1].y, bend.uv_twist.x,
                     bend.uv_twist.y}) > kStraight;
}

/// Largest distances between uvs of a quad, per coordinate.
Vec2<double> find_extent(const std::array<Vec2f, 4>& uvs) {
    Vec2<double> size{};
    for (const Vec2f& uv : uvs)
        size = {std::max(size.x, std::fabs(double(uv.x) - double(uvs[0].x))),
                std::max(size.y, std::fabs(double(uv.y) - double(uvs[0].y)))};
    return size;
}

Vec2<double> find_larger(const Vec2<double>& a, const Vec2<double>& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y)};
}

/// Directions of growing u and v of a quad in the parameters of its face.
struct QuadAxes {
    Vec2<double> u, v;

    explicit QuadAxes(const std::array<Vec2<double>, 4>& c)
        : u((c[1] - c[0] + c[2] - c[3]) * 0.5), v((c[3] - c[0] + c[2] - c[1]) * 0.5) {}
};

bool is_aligned(const std::array<Vec2<double>, 4>& c) {
    return (c[1] - c[0]).y * (c[1] - c[0]).x == 0 && (c[3] - c[0]).y * (c[3] - c[0]).x == 0 &&
           c[2] - c[1] == c[3] - c[0];
}

/// Largest length per uv at the corners of a quad, or at the corner of a polygon's part, whose uvs are
/// linear.
double measure_stretch(const LimitFace& positions, const Cage& cage, uint32_t face, uint32_t part) {
    const uint32_t start = cage.starts[face], size = cage.face_size(face);
    const auto uv = [&](uint32_t k) {
        const Vec2f& found = cage.uvs[0][start + k % size];
        return Vec2<double>{found.x, found.y};
    };
    constexpr std::array<Vec2<double>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    double stretch = 0;
    for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t corner = size == 4 ? k : part;
        const double side = size == 4 ? 1 : 0.5; // of a part
        const Vec2<double> to_next = (uv(corner + 1) - uv(corner)) * side,
                           to_previous = (uv(corner + size - 1) - uv(corner)) * side;
        const double area = std::fabs(to_next.x * to_previous.y - to_next.y * to_previous.x);
        const Vec2<double> place = size == 4 ? kCorners[k] : kCorners[0];
        const LimitSample sample = positions.evaluate(size == 4 ? 0 : part, place.x, place.y);
        if (area > 0)
            stretch = std::max(stretch, std::sqrt(compute_length(cross(sample.du, sample.dv)) / area));
    }
    return stretch;
}

} // namespace

PatchJudge::PatchJudge(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs)
    : polygons_(polygons), needs_(needs) {
    measure_bends(mesh, mesh.cage());
}

/// Measures each face, and each part of a polygon.
void PatchJudge::measure_bends(const SubdivisionMesh& mesh, const Cage& cage) {
    first_bends_.push_back(0);
    for (uint32_t face = 0; face < cage.face_count(); ++face)
        first_bends_.push_back(first_bends_.back() + (cage.face_size(face) == 4 ? 1 : cage.face_size(face)));
    bends_.resize(first_bends_.back());
    const bool has_uvs = needs_.change && cage.has_uvs && mesh.has_smooth_uvs();
    const bool needs_positions = needs_.patches == BasePatches::bilinear || needs_.has_relative_lengths ||
                                 (needs_.change && needs_.change->is_tangent());
    if (!has_uvs && !needs_positions) return;
    parallel_for("bends of faces", cage.face_count(), 64, [&](size_t begin, size_t end) {
        for (uint32_t face = uint32_t(begin); face < end; ++face) {
            std::optional<LimitFace> positions, uvs;
            if (needs_positions) positions.emplace(mesh.make_face(face));
            if (has_uvs) uvs.emplace(mesh.make_uv_face(face, 0));
            const bool is_quad = cage.face_size(face) == 4;
            for (uint32_t part = 0; first_bends_[face] + part < first_bends_[face + 1]; ++part) {
                std::array<bool, 4> is_sharp{};
                for (uint32_t k = 0; k < 4; ++k)
                    is_sharp[k] = is_quad && cage.is_sharp[cage.edges[cage.starts[face] + k]];
                FaceBend& bend = bends_[first_bends_[face] + part];
                bend = measure_bend(positions ? &*positions : nullptr, uvs ? &*uvs : nullptr, part, is_sharp);
                if (needs_.has_relative_lengths && cage.has_uvs && !has_uvs)
                    bend.stretch = measure_stretch(*positions, cage, face, part);
            }
        }
    });
}

const FaceBend& PatchJudge::bend_of(const QuadPlace& place) const {
    const uint32_t first = first_bends_[place.face];
    return bends_[first + (first_bends_[place.face + 1] - first > 1 ? place.part : 0)];
}

double PatchJudge::find_tolerance(const QuadPlace& place) const {
    return needs_.tolerance.of_face(polygons_.source_faces[place.face]);
}

/// Whether the parameters of a patch are to follow its uvs.
bool PatchJudge::follows_uvs(const RefinedMesh& refined, const FaceBend& bend) const {
    return needs_.change && !refined.uvs.empty() && has_curved_uvs(bend);
}

bool PatchJudge::needs_fit(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits) const {
    const QuadPlace& place = refined.places[quad];
    return follows_uvs(refined, bend_of(place)) || !is_aligned(place.corners) ||
           !limits.positions().is_bicubic_within(place);
}

std::array<SideFit, 4> PatchJudge::fit_sides(const RefinedMesh& refined, uint32_t quad,
                                             const std::array<bool, 4>& is_wanted,
                                             const std::array<bool, 4>& is_seam,
                                             LimitSurfaces& limits) const {
    const QuadPlace& place = refined.places[quad];
    PatchFit fit(limits.positions(), refined, quad);
    std::array<SideFit, 4> sides;
    if (!follows_uvs(refined, bend_of(place))) {
        for (size_t k = 0; k < 4; ++k)
            if (is_wanted[k]) sides[k] = fit.fit_side(k);
        return sides;
    }
    const std::array<Vec2f, 4>& uvs = refined.uvs[quad];
    const UvMatching matching(limits.uvs(), place, uvs);
    const bool is_bicubic = limits.positions().is_bicubic() && limits.uvs().is_bicubic();
    for (size_t k = 0; k < 4; ++k) {
        const bool may_leave = is_bicubic && !is_seam[k] && !refined.is_sharp[refined.edges[quad][k]];
        if (is_wanted[k]) sides[k] = fit_side(fit, k, matching, uvs, may_leave, place);
    }
    return sides;
}

/// The curve with the parameters of the face, if uvs are near enough on it, or else the one that follows
/// uvs, unless it is the worse one.
SideFit PatchJudge::fit_side(PatchFit& fit, size_t k, const UvMatching& matching,
                             const std::array<Vec2f, 4>& uvs, bool may_leave_side,
                             const QuadPlace& place) const {
    const double tolerance = find_tolerance(place);
    const auto judge_side = [&](const SideFit& side) {
        return side.off + find_change(uvs, side.uv_error, place);
    };
    const auto fit_plain = [&] {
        SideFit plain = fit.fit_side(k);
        for (size_t n = 0; n < kSideSamples; ++n)
            plain.uv_error = find_larger(
                plain.uv_error, matching.measure_on_side(k, place_of_side_sample(n), plain.places[n]));
        return plain;
    };
    std::optional<SideFit> plain;
    if (fit.has_exact_side(k)) plain = fit_plain();
    if (plain && judge_side(*plain) <= kSmallestCause * tolerance) return *plain;
    SideFit following = fit.fit_side_to_uvs(k, matching, may_leave_side);
    if (judge_side(following) <= tolerance) return following;
    if (!plain) plain = fit_plain();
    return judge_side(*plain) < judge_side(following) ? *plain : following;
}

void PatchJudge::judge_flat(const QuadPlace& place, const FaceBend& bend, Judgement& judgement) const {
    const QuadAxes axes(place.corners);
    const BendAlong along_u = find_bend_along(bend, axes.u), along_v = find_bend_along(bend, axes.v);
    const double tolerance = find_tolerance(place);
    const double twist = bend.position_twist * std::fabs(axes.u.x * axes.v.y - axes.u.y * axes.v.x) / 4;
    judgement.part = (along_u.position + along_v.position + twist) / tolerance;
    if (judgement.part <= 1) return;
    const auto choose = [&](double off, const Vec2<double>& way) {
        return off + twist / 2 > tolerance / 2 && measure(way) > std::ldexp(1.5, -kFinestPatchLevel);
    };
    judgement.splits_u = choose(along_u.position, axes.u);
    judgement.splits_v = choose(along_v.position, axes.v);
}

Judgement PatchJudge::judge(const RefinedMesh& refined, uint32_t quad, const SideFits& sides,
                            LimitSurfaces& limits) const {
    Judgement judgement;
    const QuadPlace& place = refined.places[quad];
    const FaceBend& bend = bend_of(place);
    if (needs_.patches == BasePatches::bilinear) {
        judge_flat(place, bend, judgement);
        return judgement;
    }
    const QuadAxes axes(place.corners);
    const BendAlong along_u = find_bend_along(bend, axes.u), along_v = find_bend_along(bend, axes.v);
    const double tolerance = find_tolerance(place), smallest = std::min(measure(axes.u), measure(axes.v));
    const double frame_u = find_frame_error(along_u, bend), frame_v = find_frame_error(along_v, bend);
    const bool is_exact = is_aligned(place.corners) && limits.positions().is_bicubic_within(place);
    const bool follows = follows_uvs(refined, bend);
    bool has_exact_sides = is_exact;
    for (const SideFit* side : sides) has_exact_sides = has_exact_sides && !(side && side->follows_uvs);
    // The patch of the face itself is exact except for its uvs.
    PatchError error;
    if (has_exact_sides && follows)
        error.change = find_change(refined.uvs[quad], along_u.uv + along_v.uv, place);
    for (const SideFit* side : sides) error.off = std::max(error.off, side ? side->off : 0.0);
    if (!has_exact_sides || error.change + frame_u + frame_v > tolerance) {
        judgement.depends_on_tolerance = has_exact_sides;
        if (!has_exact_sides || follows) {
            const PatchError fitted = fit_patch(refined, quad, sides, follows, limits, judgement);
            if (!has_exact_sides || fitted.sum() < error.sum())
                error = fitted;
            else
                judgement.fitted = nullptr;
        }
    }
    judgement.depends_on_tolerance = judgement.depends_on_tolerance || follows;
    judgement.part = (error.sum() + frame_u + frame_v) / tolerance;
    if (judgement.part <= 1) return judgement;
    const double cause = kSmallestCause * tolerance, finest = std::ldexp(1.5, -kFinestUvLevel);
    const bool has_bad_uvs = error.change > cause || (is_exact && error.off > cause);
    judgement.splits_u = (has_bad_uvs || frame_u > cause) && measure(axes.u) > finest;
    judgement.splits_v = (has_bad_uvs || frame_v > cause) && measure(axes.v) > finest;
    judgement.splits_fit = !is_exact && error.off > cause && smallest > std::ldexp(1.5, -kFinestPatchLevel);
    if (judgement.splits_fit) judgement.splits_u = judgement.splits_v = false;
    for (size_t k = 0; k < 4; ++k)
        judgement.splits_side[k] = judgement.splits_fit && sides[k] && sides[k]->off > cause;
    return judgement;
}

/// Measures how far uvs are off on a side that was fitted for a quad with other uvs.
void PatchJudge::measure_seam(const RefinedMesh& refined, uint32_t quad, size_t k, const UvMatching& matching,
                              SideFit& side) {
    const bool is_same_way = side.first_point == refined.points[quad][k];
    const Vec2f &begin = refined.uvs[quad][k], &end = refined.uvs[quad][(k + 1) % 4];
    const bool is_seam = !(begin == side.uvs[is_same_way ? 0 : 1] && end == side.uvs[is_same_way ? 1 : 0]);
    if (!is_seam) return;
    side.uv_error = {};
    for (size_t n = 0; n < kSideSamples; ++n) {
        const double s = place_of_side_sample(n), place = side.places[n];
        side.uv_error = find_larger(side.uv_error, matching.measure_on_side(k, is_same_way ? s : 1 - s,
                                                                            is_same_way ? place : 1 - place));
    }
}

/// Fits the inside of a patch between its sides.
PatchJudge::PatchError PatchJudge::fit_patch(const RefinedMesh& refined, uint32_t quad, const SideFits& sides,
                                             bool follows, LimitSurfaces& limits,
                                             Judgement& judgement) const {
    PatchFit fit(limits.positions(), refined, quad);
    std::optional<UvMatching> matching;
    if (follows) matching.emplace(limits.uvs(), refined.places[quad], refined.uvs[quad]);
    for (size_t k = 0; k < 4; ++k) {
        SideFit side = sides[k] ? *sides[k] : fit.fit_side(k);
        if (follows || side.follows_uvs) {
            if (!matching) matching.emplace(limits.uvs(), refined.places[quad], refined.uvs[quad]);
            measure_seam(refined, quad, k, *matching, side);
        }
        fit.take_side(k, side);
    }
    const QuadPlace& place = refined.places[quad];
    const PatchFit with_sides = fit;
    if (!follows) {
        fit.fit_inside();
        judgement.fitted = std::make_unique<std::array<Vec3d, 12>>(fit.controls());
        if (!needs_.change || refined.uvs.empty()) return {fit.distance(), 0};
        const std::array<Vec2f, 4>& uvs = refined.uvs[quad];
        return {fit.distance(), find_change(uvs, find_extent(uvs) * fit.lag() + fit.uv_error(), place)};
    }
    const std::array<Vec2f, 4>& uvs = refined.uvs[quad];
    fit.fit_inside_to_uvs(*matching);
    judgement.fitted = std::make_unique<std::array<Vec3d, 12>>(fit.controls());
    const PatchError error{fit.distance(), find_change(uvs, fit.uv_error(), place)};
    if (error.sum() <= find_tolerance(place)) return error;
    return choose_nearest(with_sides, uvs, place, error, judgement);
}

/// Chooses the patch that is nearest to the surface if that is better than one with the error `before`.
PatchJudge::PatchError PatchJudge::choose_nearest(const PatchFit& with_sides, const std::array<Vec2f, 4>& uvs,
                                                  const QuadPlace& place, const PatchError& before,
                                                  Judgement& judgement) const {
    PatchFit nearest = with_sides;
    nearest.fit_inside();
    const QuadAxes axes(place.corners);
    const Vec2<double> bent =
        find_bend_along(bend_of(place), axes.u).uv + find_bend_along(bend_of(place), axes.v).uv;
    const Vec2<double> uv_error = find_extent(uvs) * nearest.lag() + find_larger(nearest.uv_error(), bent);
    const PatchError error{nearest.distance(), find_change(uvs, uv_error, place)};
    if (error.sum() >= before.sum()) return before;
    judgement.fitted = std::make_unique<std::array<Vec3d, 12>>(nearest.controls());
    return error;
}

double PatchJudge::find_change(const std::array<Vec2f, 4>& uvs, const Vec2<double>& error,
                               const QuadPlace& place) const {
    const double stretch = needs_.has_relative_lengths ? bend_of(place).stretch : 1;
    const double enough = kSmallestCause * find_tolerance(place);
    return stretch * needs_.change->find_change(uvs, error, stretch > 0 ? enough / stretch : 0);
}

/// Error of the displacement by frames that are interpolated across a quad.
double PatchJudge::find_frame_error(const BendAlong& along, const FaceBend& bend) const {
    if (!needs_.change || !needs_.change->is_tangent()) return 0;
    const double bent = needs_.change->uses_tangents() ? std::max(along.normal, along.tangent) : along.normal;
    const double error = bent * needs_.change->longest();
    return needs_.has_relative_lengths ? error * bend.stretch : error;
}

} // namespace relief
