#include "surface/mesh/adaptive_cage.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "surface/mesh/edge_splits.h"
#include "surface/mesh/face_splitter.h"
#include "surface/mesh/limit_patches.h"
#include "surface/mesh/patch_budget.h"
#include "surface/mesh/patch_judge.h"

namespace relief {

namespace {

constexpr int kMostRounds = 10;
/// From this share of the quads of a connected part of the mesh on, all are cut.
constexpr double kManyQuads = 0.3;
constexpr double kMostSpare = 40;
constexpr const char* kWhat = "its automatic subdivision";

RefinedMesh make_refined(const Cage& cage) {
    RefinedMesh refined;
    refined.is_adaptive = true;
    refined.point_count = cage.point_count;
    const uint32_t count = cage.face_count();
    refined.points.resize(count), refined.edges.resize(count);
    refined.places = cage.places;
    refined.first_quads.assign(cage.is_sharp.size(), kNoIndex);
    for (uint32_t quad = count; quad-- > 0;)
        for (size_t k = 0; k < 4; ++k) {
            refined.points[quad][k] = cage.points[4 * quad + k];
            refined.edges[quad][k] = cage.edges[4 * quad + k];
            refined.first_quads[refined.edges[quad][k]] = quad;
        }
    for (size_t set = 0; set < cage.uvs.size(); ++set) {
        std::vector<std::array<Vec2f, 4>> uvs(count);
        for (size_t corner = 0; corner < cage.uvs[set].size(); ++corner)
            uvs[corner / 4][corner & 3] = cage.uvs[set][corner];
        if (set == 0 && cage.has_uvs)
            refined.uvs = std::move(uvs);
        else
            refined.further_uvs.push_back(std::move(uvs));
    }
    refined.is_sharp = cage.is_sharp, refined.semi_sharpness = cage.semi_sharpness;
    refined.is_bent.assign(cage.is_sharp.size(), false);
    refined.is_regular = cage.is_regular, refined.is_straight = cage.is_straight;
    refined.limit_normals = cage.limit_normals;
    return refined;
}

/// Limit uvs at places of faces, asked for face by face.
class LimitUvs {
  public:
    LimitUvs(const SubdivisionMesh& mesh, const Cage& cage)
        : mesh_(mesh), cage_(cage), faces_(cage.uvs.size()) {}

    Vec2f find(uint32_t set, const QuadPlace& face, const Vec2<double>& at) {
        if (!mesh_.has_smooth_uvs()) return interpolate(set, face, at);
        if (face.face != number_) {
            number_ = face.face;
            for (std::optional<LimitFace>& limit : faces_) limit.reset();
        }
        if (!faces_[set]) faces_[set].emplace(mesh_.make_uv_face(face.face, set));
        const Vec3d uv = faces_[set]->evaluate(face.part, at.x, at.y).position;
        return {float(uv.x), float(uv.y)};
    }

  private:
    /// Interpolates linearly within the face, or within the part of a polygon.
    Vec2f interpolate(uint32_t set, const QuadPlace& face, const Vec2<double>& at) const {
        const uint32_t start = cage_.starts[face.face], size = cage_.face_size(face.face);
        const auto corner = [&](uint32_t k) {
            const Vec2f& uv = cage_.uvs[set][start + k % size];
            return Vec2<double>{uv.x, uv.y};
        };
        std::array<Vec2<double>, 4> c;
        for (uint32_t k = 0; k < 4; ++k) c[k] = corner(k);
        if (size != 4) {
            const uint32_t k = face.part;
            Vec2<double> sum{};
            for (uint32_t n = 0; n < size; ++n) sum = sum + corner(n);
            c = {corner(k), (corner(k) + corner(k + 1)) * 0.5, sum * (1.0 / size),
                 (corner(k) + corner(k + size - 1)) * 0.5};
        }
        const Vec2<double> uv =
            (c[0] * (1 - at.x) + c[1] * at.x) * (1 - at.y) + (c[3] * (1 - at.x) + c[2] * at.x) * at.y;
        return {float(uv.x), float(uv.y)};
    }

    const SubdivisionMesh& mesh_;
    const Cage& cage_;
    std::vector<std::optional<LimitFace>> faces_; ///< per set, of the face asked for last
    uint32_t number_ = kNoIndex;
};

double find_side(const Vec2<double>& way) { return std::max(std::fabs(way.x), std::fabs(way.y)); }

/// Chooses the edges to split, round by round.
class AdaptiveCage {
  public:
    AdaptiveCage(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs)
        : mesh_(mesh),
          polygons_(polygons),
          needs_(needs),
          judge_(mesh, polygons, needs),
          source_(mesh.cage()),
          cage_(source_) {}

    RefinedMesh run() {
        check_patch_count(source_.face_count(), polygons_.where, kWhat);
        bool has_polygons = false;
        for (uint32_t face = 0; face < source_.face_count(); ++face)
            has_polygons = has_polygons || source_.face_size(face) != 4;
        if (has_polygons) split(std::vector<uint8_t>(source_.is_sharp.size()));
        find_parts();
        for (int round = 0; round <= kMostRounds; ++round) {
            std::vector<uint8_t> is_split = choose_splits(round == kMostRounds);
            if (is_split.empty()) break;
            is_cut_ = true;
            split(std::move(is_split));
        }
        RefinedMesh refined = make_refined(cage_);
        refined.fits = std::move(cage_.fits), refined.fitted = std::move(fitted_);
        return refined;
    }

    BaseReserve reserve() const {
        const double part = std::max(largest_part_, std::exp2(-kMostSpare));
        return {std::max(0, -int(std::ceil(2 * std::log2(part)))), is_cut_};
    }

  private:
    void split(std::vector<uint8_t> is_split) {
        make_splits_even(cage_, is_split);
        check_patch_count(count_pieces(cage_, is_split), polygons_.where, kWhat);
        LimitUvs uvs(mesh_, source_);
        cage_ =
            split_faces(cage_, is_split, [&](uint32_t set, const QuadPlace& face, const Vec2<double>& at) {
                return uvs.find(set, face, at);
            });
    }

    /// One byte per edge; empty: all quads are near enough, or `is_last` and nothing is split.
    std::vector<uint8_t> choose_splits(bool is_last) {
        const RefinedMesh refined = make_refined(cage_);
        const std::vector<uint32_t> runs = find_face_runs(refined);
        if (needs_.patches == BasePatches::bicubic) fit_new_sides(refined, runs);
        std::vector<Judgement> judgements(cage_.face_count());
        visit_open_quads(refined, runs, [&](uint32_t quad, LimitSurfaces& limits) {
            judgements[quad] = judge_.judge(refined, quad, list_sides(refined, quad), limits);
        });
        std::vector<uint8_t> is_split(cage_.is_sharp.size()), has_spokes(cage_.point_count);
        if (is_last)
            for (Judgement& judgement : judgements)
                judgement.splits_u = judgement.splits_v = judgement.splits_fit = false;
        else
            widen_splits(judgements);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad)
            if (!cage_.is_accurate[quad]) mark_splits(quad, judgements[quad], is_split, has_spokes);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad)
            for (uint32_t k = 0; k < 4; ++k)
                if (has_spokes[cage_.points[4 * quad + k]])
                    is_split[cage_.edges[4 * quad + k]] = is_split[cage_.edges[4 * quad + (k + 3) % 4]] = 1;
        if (std::ranges::find(is_split, 1) == is_split.end()) is_split.clear();
        return is_split;
    }

    /// Calls `visit(quad, limits)` for all quads that are not known to be accurate, on all threads.
    template <class Visit>
    void visit_open_quads(const RefinedMesh& refined, const std::vector<uint32_t>& runs, const Visit& visit) {
        parallel_for("errors of patches", runs.size() - 1, 64, [&](size_t begin, size_t end) {
            for (size_t run = begin; run < end; ++run) {
                LimitSurfaces limits{mesh_, refined.places[runs[run]].face, {}, {}};
                for (uint32_t quad = runs[run]; quad < runs[run + 1]; ++quad)
                    if (!cage_.is_accurate[quad]) visit(quad, limits);
            }
        });
    }

    /// Per edge whether its quads have different uvs there.
    static std::vector<uint8_t> find_seams(const RefinedMesh& refined) {
        std::vector<uint8_t> is_seam(refined.first_quads.size());
        for (uint32_t quad = 0; quad < refined.quad_count() && !refined.uvs.empty(); ++quad)
            for (size_t k = 0; k < 4; ++k) {
                const uint32_t edge = refined.edges[quad][k];
                if (refined.first_quads[edge] == quad) continue;
                const auto [owner, other, is_same_way] = find_owner_side(refined, quad, k);
                const Vec2f &begin = refined.uvs[owner][(other + (is_same_way ? 0 : 1)) % 4],
                            &end = refined.uvs[owner][(other + (is_same_way ? 1 : 0)) % 4];
                if (!(refined.uvs[quad][k] == begin && refined.uvs[quad][(k + 1) % 4] == end))
                    is_seam[edge] = 1;
            }
        return is_seam;
    }

    /// Fits the edges that have no curve yet and need one, each by the lowest quad that needs it. A quad that
    /// is known to be accurate and has no curve there is exact, and so is the curve that the other one finds.
    void fit_new_sides(const RefinedMesh& refined, const std::vector<uint32_t>& runs) {
        std::vector<uint8_t> needs_fit(cage_.face_count());
        visit_open_quads(refined, runs, [&](uint32_t quad, LimitSurfaces& limits) {
            needs_fit[quad] = judge_.needs_fit(refined, quad, limits);
        });
        const auto first_new = uint32_t(side_fits_.size());
        std::vector<uint32_t> fitters; // per new curve
        for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
            for (size_t k = 0; k < 4 && needs_fit[quad]; ++k)
                if (uint32_t& fit = cage_.side_fits[refined.edges[quad][k]]; fit == kNoIndex)
                    fit = first_new + uint32_t(fitters.size()), fitters.push_back(quad);
        if (fitters.empty()) return;
        side_fits_.resize(first_new + fitters.size());
        const std::vector<uint8_t> is_seam = find_seams(refined);
        visit_open_quads(refined, runs, [&](uint32_t quad, LimitSurfaces& limits) {
            std::array<bool, 4> is_wanted{}, is_own_seam{};
            for (size_t k = 0; k < 4; ++k) {
                const uint32_t edge = refined.edges[quad][k], fit = cage_.side_fits[edge];
                is_wanted[k] = fit != kNoIndex && fit >= first_new && fitters[fit - first_new] == quad;
                is_own_seam[k] = is_seam[edge] != 0;
            }
            if (is_wanted == std::array<bool, 4>{}) return;
            const std::array<SideFit, 4> fits =
                judge_.fit_sides(refined, quad, is_wanted, is_own_seam, limits);
            for (size_t k = 0; k < 4; ++k)
                if (is_wanted[k]) side_fits_[cage_.side_fits[refined.edges[quad][k]]] = fits[k];
        });
    }

    SideFits list_sides(const RefinedMesh& refined, uint32_t quad) const {
        SideFits sides{};
        for (size_t k = 0; k < 4; ++k) {
            const uint32_t fit = cage_.side_fits[refined.edges[quad][k]];
            if (fit != kNoIndex) sides[k] = &side_fits_[fit];
        }
        return sides;
    }

    /// Where many quads of a connected part of the mesh are to be cut in both directions, all are: whole
    /// levels need fewer quads than the ways around many single ones, and are exact on bicubic faces.
    void widen_splits(std::vector<Judgement>& reasons) {
        const auto is_both = [](const Judgement& reason) { return reason.splits_u && reason.splits_v; };
        std::vector<uint32_t> quads(part_count_), wanted(part_count_);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad) {
            const uint32_t part = part_of_face_[cage_.places[quad].face];
            ++quads[part], wanted[part] += is_both(reasons[quad]) && !cage_.is_accurate[quad];
        }
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad) {
            const uint32_t part = part_of_face_[cage_.places[quad].face];
            const std::array<Vec2<double>, 4>& c = cage_.places[quad].corners;
            const bool is_finest = std::min(find_side(c[1] - c[0]), find_side(c[3] - c[0])) <
                                   std::ldexp(1.5, -kFinestPatchLevel);
            if (is_finest || double(wanted[part]) < kManyQuads * double(quads[part])) continue;
            reasons[quad].splits_u = reasons[quad].splits_v = true, reasons[quad].splits_fit = false;
            cage_.is_accurate[quad] = 0;
        }
    }

    /// Numbers the connected parts of the mesh.
    void find_parts() {
        std::vector<uint32_t> root(source_.point_count);
        std::iota(root.begin(), root.end(), 0u);
        const auto find = [&](uint32_t point) {
            while (root[point] != point) point = root[point] = root[root[point]];
            return point;
        };
        for (uint32_t face = 0; face < source_.face_count(); ++face)
            for (uint32_t corner = source_.starts[face] + 1; corner < source_.starts[face + 1]; ++corner)
                root[find(source_.points[corner])] = find(source_.points[source_.starts[face]]);
        std::vector<uint32_t> number(source_.point_count, kNoIndex);
        for (uint32_t face = 0; face < source_.face_count(); ++face) {
            uint32_t& part = number[find(source_.points[source_.starts[face]])];
            if (part == kNoIndex) part = part_count_++;
            part_of_face_.push_back(part);
        }
    }

    void mark_splits(uint32_t quad, const Judgement& reasons, std::vector<uint8_t>& is_split,
                     std::vector<uint8_t>& has_spokes) {
        const uint32_t* edges = &cage_.edges[4 * quad];
        const uint32_t* points = &cage_.points[4 * quad];
        const auto mark = [&](size_t k) { is_split[edges[k & 3]] = 1; };
        if (reasons.splits_u) mark(0), mark(2);
        if (reasons.splits_v) mark(1), mark(3);
        if (!reasons.splits_fit) {
            if (reasons.splits_u || reasons.splits_v) return;
            cage_.is_accurate[quad] = 1;
            if (reasons.fitted)
                cage_.fits[quad] = uint32_t(fitted_.size()), fitted_.push_back(*reasons.fitted);
            largest_part_ = std::max(largest_part_, reasons.part);
            is_cut_ = is_cut_ || reasons.depends_on_tolerance;
            return;
        }
        // Towards creases that wear off, else towards irregular points, else in both directions.
        bool has_reason = false;
        for (size_t k = 0; k < 4; ++k) {
            if (cage_.semi_sharpness[edges[k]] > 0) mark(k + 1), mark(k + 3), has_reason = true;
            if (!cage_.is_regular[points[k]] && !cage_.is_straight[points[k]])
                has_spokes[points[k]] = 1, has_reason = true;
            if (reasons.splits_side[k]) mark(k), mark(k + 2), has_reason = true;
        }
        for (size_t k = 0; k < 4 && !has_reason; ++k) mark(k);
    }

    const SubdivisionMesh& mesh_;
    const Polygons& polygons_;
    const BaseNeeds& needs_;
    const PatchJudge judge_;
    const Cage& source_;
    Cage cage_;
    std::vector<SideFit> side_fits_;     ///< as Cage::side_fits numbers them
    std::vector<uint32_t> part_of_face_; ///< connected part of each face of the source
    uint32_t part_count_ = 0;
    std::vector<std::array<Vec3d, 12>> fitted_;
    double largest_part_ = 0; ///< of the tolerance, at quads that are accurate
    bool is_cut_ = false;     ///< for more than corners
};

} // namespace

RefinedMesh refine_adaptively(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs,
                              BaseReserve& reserve) {
    AdaptiveCage cage(mesh, polygons, needs);
    RefinedMesh refined = cage.run();
    reserve = cage.reserve();
    return refined;
}

} // namespace relief
