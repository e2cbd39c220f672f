#include "surface/mesh/irregular_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "surface/mesh/quad_cutter.h"

namespace relief {

namespace {

/// Around a point with more quads the surface shrinks less from ring to ring: that many rings more.
constexpr uint32_t kFewQuads = 5;
constexpr int kDeeper = 3;

/// How a quad is cut; (0, 0) of its view is the irregular corner, if it has one.
enum class Kind {
    whole,
    rings,  ///< around an irregular point
    strips, ///< along a crease on the side from (0, 0) to (1, 0)
    end,    ///< the same where that crease ends, turns or meets another at (0, 0)
    corner  ///< between two creases that meet at (0, 0)
};

struct Pattern {
    Kind kind = Kind::whole;
    QuadView view;
};

/// Which quads are cut, and how; fails where sides would not agree.
class Plan {
  public:
    Plan(const RefinedMesh& mesh, int depth, bool has_creases)
        : mesh_(mesh),
          depth_(depth),
          has_creases_(has_creases),
          cuts_(mesh.is_sharp.size()),
          touches_crease_(mesh.point_count),
          quads_around_(mesh.point_count) {
        for (const auto& quad : mesh.points)
            for (const uint32_t point : quad) ++quads_around_[point];
        if (!has_creases) return;
        float sharpest = 0;
        for (const float sharpness : mesh.semi_sharpness) sharpest = std::max(sharpest, sharpness);
        // `end` takes them two at a time.
        strip_depth_ = (int(std::ceil(sharpest)) + 1) / 2 * 2;
    }

    /// False where the cuts of some sides, or the quads around a crease, do not fit together.
    bool make() {
        for (uint32_t quad = 0; quad < mesh_.quad_count(); ++quad) {
            const std::optional<Pattern> pattern = classify(quad);
            if (!pattern) return false;
            patterns_.push_back(*pattern);
        }
        return drop_crowded_points() && cut_sides();
    }

    const Pattern& pattern(uint32_t quad) const { return patterns_[quad]; }
    const std::vector<SideCut>& cuts() const { return cuts_; }
    int strip_depth() const { return strip_depth_; }
    bool touches_crease(uint32_t point) const { return touches_crease_[point]; }
    int point_depth(uint32_t point) const {
        const int worn_off = int(std::ceil(mesh_.point_sharpness[point]));
        const int depth = std::max(depth_ + (quads_around_[point] > kFewQuads ? kDeeper : 0), worn_off);
        return touches_crease_[point] ? std::max(depth, strip_depth_) : depth;
    }

  private:
    bool is_crease(uint32_t edge) const { return has_creases_ && mesh_.semi_sharpness[edge] > 0; }
    bool is_irregular(uint32_t point) const {
        return !mesh_.is_regular[point] && !(has_creases_ && mesh_.is_straight[point]);
    }

    std::optional<Pattern> classify(uint32_t quad) {
        std::vector<uint32_t> corners, sides;
        for (uint32_t k = 0; k < 4; ++k) {
            if (is_irregular(mesh_.points[quad][k])) corners.push_back(k);
            if (is_crease(mesh_.edges[quad][k])) sides.push_back(k);
        }
        for (const uint32_t side : sides)
            for (const uint32_t k : {side, (side + 1) % 4}) touches_crease_[mesh_.points[quad][k]] = true;
        if (sides.empty()) {
            if (corners.size() != 1) return Pattern{Kind::whole, {quad, 0, false}};
            return Pattern{Kind::rings, {quad, corners[0], false}};
        }
        if (corners.empty() && sides.size() == 1) return Pattern{Kind::strips, {quad, sides[0], false}};
        if (corners.size() != 1 || sides.size() > 2) return std::nullopt;
        const uint32_t corner = corners[0], before = (corner + 3) % 4;
        for (const uint32_t side : sides)
            if (side != corner && side != before) return std::nullopt;
        if (sides.size() == 2) return Pattern{Kind::corner, {quad, corner, false}};
        return Pattern{Kind::end, {quad, corner, sides[0] == before}};
    }

    /// An irregular point is left alone where a quad has another one as well.
    bool drop_crowded_points() {
        std::vector<bool> is_crowded(mesh_.point_count);
        for (uint32_t quad = 0; quad < mesh_.quad_count(); ++quad)
            if (patterns_[quad].kind == Kind::whole)
                for (const uint32_t point : mesh_.points[quad])
                    if (is_irregular(point)) is_crowded[point] = true;
        for (Pattern& pattern : patterns_) {
            if (pattern.kind == Kind::whole || pattern.kind == Kind::strips) continue;
            const uint32_t point = mesh_.points[pattern.view.quad][pattern.view.turn];
            if (!is_crowded[point]) continue;
            if (touches_crease_[point]) return false;
            pattern.kind = Kind::whole;
        }
        return true;
    }

    bool cut_sides() {
        std::vector<uint32_t> cut_count(cuts_.size()), quad_count(cuts_.size());
        bool do_agree = true;
        for (const Pattern& pattern : patterns_) {
            const QuadView& view = pattern.view;
            for (const uint32_t edge : mesh_.edges[view.quad]) ++quad_count[edge];
            // Side k from the corner at its begin, or at its end.
            const auto cut = [&](uint32_t k, bool is_from_end, int depth, bool is_dense = false) {
                const uint32_t edge = mesh_.edges[view.quad][(view.turn + k) % 4];
                const SideCut side{mesh_.points[view.quad][(view.turn + k + (is_from_end ? 1 : 0)) % 4],
                                   depth, is_dense};
                do_agree = do_agree && (cut_count[edge] == 0 || cuts_[edge] == side);
                cuts_[edge] = side, ++cut_count[edge];
            };
            if (pattern.kind == Kind::strips) cut(3, true, strip_depth_);
            if (pattern.kind == Kind::rings || pattern.kind == Kind::end || pattern.kind == Kind::corner) {
                const int depth = point_depth(mesh_.points[view.quad][view.turn]);
                const bool is_dense = !touches_crease_[mesh_.points[view.quad][view.turn]];
                cut(0, false, depth, is_dense), cut(3, true, depth, is_dense);
            }
            const bool has_next = pattern.kind == Kind::end && !view.is_mirrored;
            const bool has_previous = pattern.kind == Kind::end && view.is_mirrored;
            if (pattern.kind == Kind::strips || pattern.kind == Kind::corner || has_next)
                cut(1, false, strip_depth_);
            if (pattern.kind == Kind::corner || has_previous) cut(2, true, strip_depth_);
        }
        for (size_t edge = 0; edge < cuts_.size(); ++edge)
            do_agree = do_agree && (cut_count[edge] == 0 || cut_count[edge] == quad_count[edge]);
        return do_agree;
    }

    const RefinedMesh& mesh_;
    int depth_, strip_depth_ = 0;
    bool has_creases_;
    std::vector<SideCut> cuts_;
    std::vector<Pattern> patterns_;
    std::vector<bool> touches_crease_;
    std::vector<uint32_t> quads_around_; ///< one a point
};

/// Squares halved towards (0, 0), from one of side s.
void cut_rings(QuadCutter& cutter, double s, int depth, bool is_dense = false) {
    const SideCut cut{kNoIndex, depth, is_dense};
    for (int d = 0; d < cut.count(); ++d) {
        const double h = cut.next(s, d);
        cutter.add({{{h, 0}, {s, 0}, {s, s}, {h, h}}});
        cutter.add({{{h, h}, {s, s}, {0, s}, {0, h}}});
        s = h;
    }
    cutter.add_box({0, 0}, {s, s});
}

/// 0, 2^-depth, ... 1/4, 1/2, 1, as far as `end`.
std::vector<double> make_steps(int depth, double end) {
    std::vector<double> steps = {0};
    for (double s = std::ldexp(1.0, -depth); s <= end; s *= 2) steps.push_back(s);
    return steps;
}

void cut_strips(QuadCutter& cutter, int depth, double x0, double x1, double end) {
    const std::vector<double> y = make_steps(depth, end);
    for (size_t k = 0; k + 1 < y.size(); ++k) cutter.add_box({x0, y[k]}, {x1, y[k + 1]});
}

/// The squares beside (0, 0) inherit its cuts towards that point; all others are products.
void cut_corner(QuadCutter& cutter, int depth, int point_depth) {
    const std::vector<double> x = make_steps(depth, 1);
    for (size_t k = 1; k + 1 < x.size(); ++k) {
        cutter.add_box({0, x[k]}, {x[1], x[k + 1]});
        cut_strips(cutter, depth, x[k], x[k + 1], 1);
    }
    cut_rings(cutter, x[1], point_depth - depth);
}

/// Strips end on the side x = 1 but not on y = 1: quads above them take two halvings to none.
void cut_end(QuadCutter& cutter, int depth, int point_depth) {
    double s = 1;
    for (int d = 0; d < depth; d += 2, s /= 4) {
        const double q = s / 4, h = s / 2;
        // Placed by trial: the nearest that the fits come to the limit surface.
        const QuadCutter::Corner inner = Vec2<double>{5.0 / 32, 12.0 / 32} * s;
        const QuadCutter::Corner outer = Vec2<double>{22.0 / 32, 12.0 / 32} * s;
        cut_strips(cutter, depth, q, h, q);
        cut_strips(cutter, depth, h, s, q);
        cutter.add({{{0, q}, {q, q}, inner, {0, h}}});
        cutter.add({{{q, q}, {h, q}, outer, inner}});
        cutter.add({{{h, q}, {s, q}, {s, h}, outer}});
        cutter.add({{inner, outer, {s, h}, {0, h}}});
        cutter.add_box({0, h}, {s, s});
        cutter.bend({0, h}, {s, h});
    }
    cut_rings(cutter, s, point_depth - depth);
}

RefinedMesh carry_out(const Plan& plan, const RefinedMesh& mesh) {
    QuadCutter cutter(mesh, plan.cuts());
    for (uint32_t quad = 0; quad < mesh.quad_count(); ++quad) {
        const auto& [kind, view] = plan.pattern(quad);
        if (kind == Kind::whole) {
            cutter.add_whole(quad);
            continue;
        }
        cutter.begin(view);
        const int point_depth = plan.point_depth(mesh.points[quad][view.turn]);
        if (kind == Kind::rings)
            cut_rings(cutter, 1, point_depth, !plan.touches_crease(mesh.points[quad][view.turn]));
        if (kind == Kind::strips) cut_strips(cutter, plan.strip_depth(), 0, 1, 1);
        if (kind == Kind::end) cut_end(cutter, plan.strip_depth(), point_depth);
        if (kind == Kind::corner) cut_corner(cutter, plan.strip_depth(), point_depth);
    }
    return cutter.finish();
}

} // namespace

void cut_at_irregular_points(RefinedMesh& refined, int depth) {
    Plan with_creases(refined, depth, true);
    if (with_creases.strip_depth() > 0 && with_creases.make()) {
        RefinedMesh cut = carry_out(with_creases, refined);
        for (uint32_t point = 0; point < refined.point_count; ++point)
            if (refined.is_straight[point]) cut.is_regular[point] = true;
        refined = std::move(cut);
        return;
    }
    Plan plain(refined, depth, false);
    [[maybe_unused]] const bool is_sound = plain.make();
    DCHECK(is_sound);
    refined = carry_out(plain, refined);
}

} // namespace relief
