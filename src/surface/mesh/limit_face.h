// The limit surface of one face of a subdivision mesh: positions, or uvs, with derivatives.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "surface/mesh/quad_place.h"
#include "surface/mesh/spline_patch.h"

namespace relief {

class LimitCells;

/// The limit surface of one face; for one thread.
class LimitFace {
  public:
    struct Surface; ///< cells of splines, or as OpenSubdiv evaluates it
    /// `is_bicubic_apart`: except where it is nearest to its irregular corners, as is_bicubic_within() finds.
    LimitFace(std::shared_ptr<const Surface> surface, uint32_t irregular_corners, bool is_bicubic_apart);
    explicit LimitFace(const SplineControls& controls);
    ~LimitFace();
    LimitFace(LimitFace&&) noexcept;

    /// Evaluates the limit at (u, v) in [0, 1]^2 of the face, or of the part of a polygon beside corner
    /// `part`. For uvs z is 0.
    LimitSample evaluate(uint32_t part, double u, double v) const;

    /// The same with the mixed second derivative.
    LimitSample evaluate_with_twist(uint32_t part, double u, double v) const;

    /// The position of evaluate(), in less time.
    Vec3d evaluate_position(uint32_t part, double u, double v) const;

    /// Whether the whole face is one bicubic polynomial.
    bool is_bicubic() const { return surface_ == nullptr; }
    /// Whether creases that wear off may touch the face.
    bool has_creases() const { return !is_bicubic_apart_; }
    /// Whether the limit is known to be one bicubic polynomial in the rectangle around a quad.
    bool is_bicubic_within(const QuadPlace& quad) const;

  private:
    bool has_cells() const;
    const LimitCells& cells_of(uint32_t part) const;
    double find_place(uint32_t part, double u, double v, double (&place)[2]) const;

    std::shared_ptr<const Surface> surface_; ///< null: the face is the spline of `controls_`
    SplineControls controls_;
    uint32_t irregular_corners_ = 0; ///< bit k: corner k of the quad, or of every part of a polygon
    bool is_bicubic_apart_ = true;
};

} // namespace relief
