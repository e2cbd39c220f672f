// Cross-sections that fold over: a curve (x, h) over a parameter, x moving back where the shape overhangs.
#pragma once

#include <initializer_list>
#include <vector>

#include "math/vec.h"

namespace relief::samples {

/// Smooth curve through control points (Catmull-Rom), the parameter [0, 1] spread evenly over the spans.
class ProfileCurve {
  public:
    /// How the curve goes on before its first and behind its last point.
    enum class Ends { free, mirrored };

    /// At least two points. `mirrored`: x is odd about both ends and h even, so that copies join smoothly.
    ProfileCurve(std::vector<Vec2f> points, Ends ends);

    /// Point at q, clamped to [0, 1].
    Vec2f at(float q) const;

  private:
    std::vector<Vec2f> points_; ///< with one phantom point at each end
};

struct FreeCurve : ProfileCurve {
    FreeCurve(std::initializer_list<Vec2f> points) : ProfileCurve(points, Ends::free) {}
};
struct MirroredCurve : ProfileCurve {
    MirroredCurve(std::initializer_list<Vec2f> points) : ProfileCurve(points, Ends::mirrored) {}
};

} // namespace relief::samples
