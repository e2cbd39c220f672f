// The bicubic patch of one quad on the limit surface of its face: exact where the surface is bicubic, fitted
// elsewhere (docs/decisions/bicubic-base-patches.md).
#pragma once

#include <array>
#include <span>

#include "surface/mesh/curve_fit.h"
#include "surface/mesh/side_fit.h"
#include "surface/mesh/subdivision_mesh.h"
#include "surface/mesh/uv_matching.h"

namespace relief {

/// One quad of the refined mesh; derivatives are by the quad's parameters. First its sides are fitted or
/// taken, then its inside, which follows them.
class PatchFit {
  public:
    /// Evaluates the corners. Refers to its arguments.
    PatchFit(const LimitFace& face, const RefinedMesh& refined, uint32_t quad);

    /// Finds the control points of the patch that comes nearest to the surface.
    void fit();

    /// Finds the curve that comes nearest to side k; its `uv_error` is left at 0.
    SideFit fit_side(size_t k);
    /// Finds the curve of side k whose points have the limit uvs that the quad interpolates along it. With
    /// `may_leave_side` they are looked for beside the side, too.
    SideFit fit_side_to_uvs(size_t k, const UvMatching& uvs, bool may_leave_side);
    /// Takes a curve that was fitted by this quad or by the one across the side.
    void take_side(size_t k, const SideFit& side);
    /// Whether side k is a cubic that fit_side() does not change.
    bool has_exact_side(size_t k) const;

    /// Finds the inner control points that come nearest to the surface.
    void fit_inside();
    /// Finds those of a patch whose uvs, bilinear between the corners, are the limit uvs as well.
    void fit_inside_to_uvs(const UvMatching& uvs);

    const Vec3d& corner(size_t k) const { return corner_[k]; }
    const Vec3d& normal(size_t k) const { return normal_[k]; }
    /// In the order of InnerControls; once fitted.
    const std::array<Vec3d, 12>& controls() const { return control_; }
    /// Takes those of the same quad, fitted before.
    void take(const std::array<Vec3d, 12>& controls) { control_ = controls; }
    /// Largest distance of the samples from the fitted patch; 0 for an exact one.
    double distance() const { return distance_; }
    /// How far along u or v samples are on the patch from where they are on the face, in parts of the patch.
    double lag() const { return lag_; }
    /// How far uvs are off at most, per coordinate: on the sides, and inside after fit_inside_to_uvs().
    const Vec2<double>& uv_error() const { return uv_error_; }

  private:
    Vec2<double> side(size_t k) const { return place_.corners[(k + 1) % 4] - place_.corners[k]; }
    bool is_along_axis(size_t k) const { return side(k).x == 0 || side(k).y == 0; }
    bool is_cubic(size_t k) const;
    bool is_exact() const;
    Vec2<double> find_place(double x, double y) const;
    Vec3d evaluate(double x, double y) const;
    Vec3d evaluate_edge(size_t k, double s) const;
    Vec3d find_normal(size_t k, const LimitSample& sample) const;
    Vec3d flatten(const Vec3d& control, size_t k) const;
    SideFit start_side(size_t k) const;
    double measure_side(const Curve& curve, size_t k) const;

    struct Sample {
        Vec3d target;
        double x, y; ///< of the target on the face
        double u, v; ///< of the nearest point of the patch
    };
    struct Misses {
        double off = 0;          ///< largest distance of the surface
        Vec2<double> uv_error{}; ///< largest one per coordinate
    };
    double project(Sample& sample) const;
    double measure_beside_sides() const;
    double project_all(std::array<Sample, 25>& samples);
    Vec3d blend(double x, double y) const;
    void add_miss(const UvMatching::Match& match, const Vec3d& miss, Misses& misses) const;
    void solve_inside(std::span<const Sample> samples);

    const LimitFace& face_;
    const RefinedMesh& refined_;
    uint32_t quad_;
    const QuadPlace& place_;
    std::array<bool, 4> is_regular_{};
    bool is_in_bicubic_part_ = false;
    bool has_exact_sides_ = true; ///< those that were taken are what fit_side() finds
    std::array<Vec3d, 4> corner_{}, normal_{}, to_next_{}, to_previous_{}, twist_{};
    std::array<Vec3d, 12> control_{};
    double distance_ = 0, lag_ = 0, negligible_ = 0;
    Vec2<double> uv_error_{};
};

} // namespace relief
