#include "surface/mesh/adaptive_cage.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "surface/mesh/edge_splits.h"
#include "surface/mesh/face_bend.h"
#include "surface/mesh/face_splitter.h"
#include "surface/mesh/limit_patches.h"
#include "surface/mesh/patch_budget.h"
#include "surface/mesh/patch_fit.h"

namespace relief {

namespace {

constexpr int kMostRounds = 8;
/// From this share of the quads of a connected part of the mesh on, all are cut.
constexpr double kManyQuads = 0.3;
constexpr double kMostSpare = 40;
constexpr const char* kWhat = "its automatic subdivision";
/// A cause of error is acted on from this part of the tolerance on.
constexpr double kSmallestCause = 0.25;

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

/// The limit surfaces of a face, each made when it is first needed.
struct LimitSurfaces {
    const SubdivisionMesh& mesh;
    uint32_t face;
    std::optional<LimitFace> own_positions, own_uvs;

    const LimitFace& positions() {
        if (!own_positions) own_positions.emplace(mesh.make_face(face));
        return *own_positions;
    }
    const LimitFace& uvs() {
        if (!own_uvs) own_uvs.emplace(mesh.make_uv_face(face, 0));
        return *own_uvs;
    }
};

/// Why a quad is to be cut.
struct SplitReasons {
    bool splits_u = false, splits_v = false;       ///< its edges along that direction
    bool splits_fit = false;                       ///< the fitted patch is too far away
    std::unique_ptr<std::array<Vec3d, 12>> fitted; ///< null: no fit was needed
    bool depends_on_tolerance = false;             ///< another tolerance might choose another fit
    double part = 0; ///< of the tolerance that the errors come to, also where no smaller quads are allowed
};

/// Chooses the edges to split, round by round.
class AdaptiveCage {
  public:
    AdaptiveCage(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs)
        : mesh_(mesh), polygons_(polygons), needs_(needs), source_(mesh.cage()), cage_(source_) {}

    RefinedMesh run() {
        check_patch_count(source_.face_count(), polygons_.where, kWhat);
        bool has_polygons = false;
        for (uint32_t face = 0; face < source_.face_count(); ++face)
            has_polygons = has_polygons || source_.face_size(face) != 4;
        if (has_polygons) split(std::vector<uint8_t>(source_.is_sharp.size()));
        measure_bends();
        find_parts();
        for (int round = 0; round < kMostRounds; ++round) {
            std::vector<uint8_t> is_split = choose_splits();
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

    /// Measures each face, and each part of a polygon.
    void measure_bends() {
        first_bends_.push_back(0);
        for (uint32_t face = 0; face < source_.face_count(); ++face)
            first_bends_.push_back(first_bends_.back() +
                                   (source_.face_size(face) == 4 ? 1 : source_.face_size(face)));
        bends_.resize(first_bends_.back());
        const bool has_uvs = needs_.change && source_.has_uvs && mesh_.has_smooth_uvs();
        parallel_for("bends of faces", source_.face_count(), 64, [&](size_t begin, size_t end) {
            for (uint32_t face = uint32_t(begin); face < end; ++face) {
                const LimitFace limit = mesh_.make_face(face);
                std::optional<LimitFace> uvs;
                if (has_uvs) uvs.emplace(mesh_.make_uv_face(face, 0));
                const bool is_quad = source_.face_size(face) == 4;
                for (uint32_t part = 0; first_bends_[face] + part < first_bends_[face + 1]; ++part) {
                    std::array<bool, 4> is_sharp{};
                    for (uint32_t k = 0; k < 4; ++k)
                        is_sharp[k] = is_quad && source_.is_sharp[source_.edges[source_.starts[face] + k]];
                    bends_[first_bends_[face] + part] =
                        measure_bend(limit, uvs ? &*uvs : nullptr, part, is_sharp);
                }
            }
        });
    }

    /// One byte per edge; empty: all quads are near enough.
    std::vector<uint8_t> choose_splits() {
        const RefinedMesh refined = make_refined(cage_);
        const std::vector<uint32_t> runs = find_face_runs(refined);
        std::vector<SplitReasons> reasons(cage_.face_count());
        parallel_for("errors of patches", runs.size() - 1, 64, [&](size_t begin, size_t end) {
            for (size_t run = begin; run < end; ++run) {
                LimitSurfaces limits{mesh_, refined.places[runs[run]].face, {}, {}};
                for (uint32_t quad = runs[run]; quad < runs[run + 1]; ++quad)
                    if (!cage_.is_accurate[quad]) reasons[quad] = judge(refined, quad, limits);
            }
        });
        std::vector<uint8_t> is_split(cage_.is_sharp.size()), has_spokes(cage_.point_count);
        widen_reasons(reasons);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad)
            if (!cage_.is_accurate[quad]) mark_splits(quad, reasons[quad], is_split, has_spokes);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad)
            for (uint32_t k = 0; k < 4; ++k)
                if (has_spokes[cage_.points[4 * quad + k]])
                    is_split[cage_.edges[4 * quad + k]] = is_split[cage_.edges[4 * quad + (k + 3) % 4]] = 1;
        if (std::ranges::find(is_split, 1) == is_split.end()) is_split.clear();
        return is_split;
    }

    /// Where many quads of a connected part of the mesh are to be cut in both directions, all are: whole
    /// levels need fewer quads than the ways around many single ones, and are exact on bicubic faces.
    void widen_reasons(std::vector<SplitReasons>& reasons) {
        const auto is_both = [](const SplitReasons& reason) { return reason.splits_u && reason.splits_v; };
        std::vector<uint32_t> quads(part_count_), wanted(part_count_);
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad) {
            const uint32_t part = part_of_face_[cage_.places[quad].face];
            ++quads[part], wanted[part] += is_both(reasons[quad]) && !cage_.is_accurate[quad];
        }
        for (uint32_t quad = 0; quad < cage_.face_count(); ++quad) {
            const uint32_t part = part_of_face_[cage_.places[quad].face];
            const std::array<Vec2<double>, 4>& c = cage_.places[quad].corners;
            const bool is_finest =
                std::min(measure(c[1] - c[0]), measure(c[3] - c[0])) < std::ldexp(1.5, -kFinestPatchLevel);
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

    void mark_splits(uint32_t quad, const SplitReasons& reasons, std::vector<uint8_t>& is_split,
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
        }
        for (size_t k = 0; k < 4 && !has_reason; ++k) mark(k);
    }

    /// Finds what is too far away at a quad; the quads of the cage are those of `refined`.
    SplitReasons judge(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits) const {
        const QuadPlace& place = refined.places[quad];
        const std::array<Vec2<double>, 4>& c = place.corners;
        const Vec2<double> u = (c[1] - c[0] + c[2] - c[3]) * 0.5, v = (c[3] - c[0] + c[2] - c[1]) * 0.5;
        const double tolerance = needs_.tolerance.of_face(polygons_.source_faces[place.face]);
        const FaceBend& bend =
            bends_[first_bends_[place.face] +
                   (first_bends_[place.face + 1] - first_bends_[place.face] > 1 ? place.part : 0)];
        const BendAlong along_u = find_bend_along(bend, u), along_v = find_bend_along(bend, v);
        const double smallest = std::min(measure(u), measure(v));
        SplitReasons reasons;
        if (needs_.patches == BasePatches::bilinear) {
            const double twist = bend.position_twist * std::fabs(u.x * v.y - u.y * v.x) / 4;
            reasons.part = (along_u.position + along_v.position + twist) / tolerance;
            if (reasons.part <= 1) return reasons;
            const auto choose = [&](double off, const Vec2<double>& way) {
                return off + twist / 2 > tolerance / 2 && measure(way) > std::ldexp(1.5, -kFinestPatchLevel);
            };
            reasons.splits_u = choose(along_u.position, u), reasons.splits_v = choose(along_v.position, v);
            return reasons;
        }
        const LimitFace& limit = limits.positions();
        const bool is_aligned = (c[1] - c[0]).y * (c[1] - c[0]).x == 0 &&
                                (c[3] - c[0]).y * (c[3] - c[0]).x == 0 && c[2] - c[1] == c[3] - c[0];
        const bool is_exact = is_aligned && limit.is_bicubic_within(place);
        PatchError error;
        if (needs_.change && !refined.uvs.empty() && has_curved_uvs(bend))
            error = fit_to_uvs(refined, quad, limits, bend, reasons);
        if (is_exact && reasons.fitted && error.off + error.change > tolerance) {
            // As it is, the patch has no error but that of its uvs.
            const PatchError plain{0, find_change(refined.uvs[quad], along_u.uv + along_v.uv, bend)};
            if (plain.change < error.off + error.change)
                error = plain, reasons.fitted = nullptr, reasons.depends_on_tolerance = true;
        } else if (!is_exact && reasons.fitted && error.off + error.change > tolerance) {
            error = choose_nearest(refined, quad, limits, bend, error, reasons);
        }
        if (!is_exact && !reasons.fitted) error = fit_nearest(refined, quad, limits, bend, reasons);
        const double frame_u = find_frame_error(along_u, bend), frame_v = find_frame_error(along_v, bend);
        reasons.part = (error.off + error.change + frame_u + frame_v) / tolerance;
        if (reasons.part <= 1) return reasons;
        const double cause = kSmallestCause * tolerance, finest = std::ldexp(1.5, -kFinestUvLevel);
        const bool has_bad_uvs = error.change > cause || (is_exact && error.off > cause);
        reasons.splits_u = (has_bad_uvs || frame_u > cause) && measure(u) > finest;
        reasons.splits_v = (has_bad_uvs || frame_v > cause) && measure(v) > finest;
        reasons.splits_fit = !is_exact && error.off > cause && smallest > std::ldexp(1.5, -kFinestPatchLevel);
        if (reasons.splits_fit) reasons.splits_u = reasons.splits_v = false;
        return reasons;
    }

    struct PatchError {
        double off = 0;    ///< the surface
        double change = 0; ///< of the displacement, as uvs are not where they belong
    };

    static bool has_curved_uvs(const FaceBend& bend) {
        constexpr double kStraight = 1e-7;
        return std::max({bend.uv[0].x, bend.uv[0].y, bend.uv[1].x, bend.uv[1].y, bend.uv_twist.x,
                         bend.uv_twist.y}) > kStraight;
    }

    /// Fits a patch whose parameters follow uvs.
    PatchError fit_to_uvs(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits,
                          const FaceBend& bend, SplitReasons& reasons) const {
        PatchFit fit(limits.positions(), refined, quad);
        fit.fit_to_uvs(limits.uvs(), refined.uvs[quad]);
        reasons.fitted = std::make_unique<std::array<Vec3d, 12>>(fit.controls());
        return {fit.distance(), find_change(refined.uvs[quad], fit.uv_error(), bend)};
    }

    /// Takes the patch that is nearest to the surface in place of one with the error `before`, if it is
    /// better.
    PatchError choose_nearest(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits,
                              const FaceBend& bend, const PatchError& before, SplitReasons& reasons) const {
        SplitReasons others;
        const PatchError nearest = fit_nearest(refined, quad, limits, bend, others);
        if (nearest.off + nearest.change >= before.off + before.change) return before;
        reasons.fitted = std::move(others.fitted), reasons.depends_on_tolerance = true;
        return nearest;
    }

    PatchError fit_nearest(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits,
                           const FaceBend& bend, SplitReasons& reasons) const {
        PatchFit fit(limits.positions(), refined, quad);
        fit.fit();
        reasons.fitted = std::make_unique<std::array<Vec3d, 12>>(fit.controls());
        if (!needs_.change || refined.uvs.empty()) return {fit.distance(), 0};
        const std::array<Vec2f, 4>& uvs = refined.uvs[quad];
        Vec2<double> size{};
        for (const Vec2f& uv : uvs)
            size = {std::max(size.x, std::fabs(double(uv.x) - double(uvs[0].x))),
                    std::max(size.y, std::fabs(double(uv.y) - double(uvs[0].y)))};
        return {fit.distance(), find_change(uvs, size * fit.lag(), bend)};
    }

    static double measure(const Vec2<double>& way) { return std::max(std::fabs(way.x), std::fabs(way.y)); }

    double find_change(const std::array<Vec2f, 4>& uvs, const Vec2<double>& error,
                       const FaceBend& bend) const {
        const double change = needs_.change->find_change(uvs, error);
        return needs_.has_relative_lengths ? change * bend.stretch : change;
    }

    /// Error of the displacement by frames that are interpolated across a quad.
    double find_frame_error(const BendAlong& along, const FaceBend& bend) const {
        if (!needs_.change || !needs_.change->is_tangent()) return 0;
        const double bent =
            needs_.change->uses_tangents() ? std::max(along.normal, along.tangent) : along.normal;
        const double error = bent * needs_.change->longest();
        return needs_.has_relative_lengths ? error * bend.stretch : error;
    }

    const SubdivisionMesh& mesh_;
    const Polygons& polygons_;
    const BaseNeeds& needs_;
    const Cage& source_;
    Cage cage_;
    std::vector<uint32_t> first_bends_; ///< per face of the source, and the end of the last one
    std::vector<FaceBend> bends_;
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
