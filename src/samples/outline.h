// Closed and open curves of the plane and the signed distance from them.
#pragma once

#include <initializer_list>
#include <vector>

#include "math/vec.h"

namespace relief::samples {

struct OutlineHit {
    float distance = 0; ///< closed: positive inside; open: positive to the left of the way the curve runs
    Vec2f inward;       ///< unit, the way the distance grows
};

/// Smooth curve through control points as short straight pieces.
class Outline {
  public:
    enum class Kind { closed, open };
    Outline(const std::vector<Vec2f>& points, Kind kind);
    OutlineHit find(const Vec2f& p) const;

  private:
    Kind kind_;
    std::vector<Vec2f> pieces_;
};

struct ClosedOutline : Outline {
    ClosedOutline(std::initializer_list<Vec2f> points) : Outline(points, Kind::closed) {}
};
struct OpenOutline : Outline {
    OpenOutline(std::initializer_list<Vec2f> points) : Outline(points, Kind::open) {}
};

} // namespace relief::samples
