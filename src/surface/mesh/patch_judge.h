// How far the patch of a quad would be from the displaced limit surface, and what brings it nearer.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "surface/mesh/base_needs.h"
#include "surface/mesh/face_bend.h"
#include "surface/mesh/patch_fit.h"
#include "surface/mesh/polygons.h"
#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// Faces are not cut below 2^-k of their sides for the sake of uvs and frames, or for positions.
inline constexpr int kFinestUvLevel = 3, kFinestPatchLevel = 6;

/// Why a quad is to be cut, or the patch that it has.
struct Judgement {
    bool splits_u = false, splits_v = false;       ///< its edges along that direction
    bool splits_fit = false;                       ///< the fitted patch is too far away
    std::array<bool, 4> splits_side{};             ///< with splits_fit: so is the curve of that side
    std::unique_ptr<std::array<Vec3d, 12>> fitted; ///< null: the patch is that of the face itself
    bool depends_on_tolerance = false;             ///< another tolerance might choose another fit
    double part = 0; ///< of the tolerance that the errors come to, also where no smaller quads are allowed
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

/// The curves of a quad's sides; null where both quads are exact.
using SideFits = std::array<const SideFit*, 4>;

/// Refers to its arguments. Several threads may judge quads of different faces.
class PatchJudge {
  public:
    PatchJudge(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs);

    /// Whether the patch of a quad cannot be that of the face itself, so that its sides have to be fitted.
    bool needs_fit(const RefinedMesh& refined, uint32_t quad, LimitSurfaces& limits) const;

    /// Fits the curves of those sides of a quad that are wanted. `is_seam`: the quad across has other uvs
    /// there.
    std::array<SideFit, 4> fit_sides(const RefinedMesh& refined, uint32_t quad,
                                     const std::array<bool, 4>& is_wanted, const std::array<bool, 4>& is_seam,
                                     LimitSurfaces& limits) const;

    /// Finds what is too far away at a quad. With bilinear patches `sides` are not looked at.
    Judgement judge(const RefinedMesh& refined, uint32_t quad, const SideFits& sides,
                    LimitSurfaces& limits) const;

  private:
    struct PatchError {
        double off = 0;    ///< the surface
        double change = 0; ///< of the displacement, as uvs are not where they belong
        double sum() const { return off + change; }
    };

    void measure_bends(const SubdivisionMesh& mesh, const Cage& cage);
    const FaceBend& bend_of(const QuadPlace& place) const;
    double find_tolerance(const QuadPlace& place) const;
    bool follows_uvs(const RefinedMesh& refined, const FaceBend& bend) const;
    SideFit fit_side(PatchFit& fit, size_t k, const UvMatching& matching, const std::array<Vec2f, 4>& uvs,
                     bool may_leave_side, const QuadPlace& place) const;
    static void measure_seam(const RefinedMesh& refined, uint32_t quad, size_t k, const UvMatching& matching,
                             SideFit& side);
    void judge_flat(const QuadPlace& place, const FaceBend& bend, Judgement& judgement) const;
    PatchError fit_patch(const RefinedMesh& refined, uint32_t quad, const SideFits& sides, bool follows,
                         LimitSurfaces& limits, Judgement& judgement) const;
    PatchError choose_nearest(const PatchFit& with_sides, const std::array<Vec2f, 4>& uvs,
                              const QuadPlace& place, const PatchError& before, Judgement& judgement) const;
    double find_change(const std::array<Vec2f, 4>& uvs, const Vec2<double>& error,
                       const QuadPlace& place) const;
    double find_frame_error(const BendAlong& along, const FaceBend& bend) const;

    const Polygons& polygons_;
    const BaseNeeds& needs_;
    std::vector<uint32_t> first_bends_; ///< per face of the mesh, and the end of the last one
    std::vector<FaceBend> bends_;
};

} // namespace relief
