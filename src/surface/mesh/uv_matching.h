// Places of a face whose limit uvs are those that a patch interpolates between its corners.
//
// Uvs of a patch are bilinear, those of the limit surface are not. So that the map is where it belongs, the
// patch does not follow the parameters of the face: its point (x, y) is fitted to the point of the limit
// surface which has the uv of (x, y).
#pragma once

#include <array>
#include <optional>

#include "surface/mesh/limit_face.h"

namespace relief {

class UvMatching {
  public:
    /// Matches a quad with `uvs` at its corners. Refers to its arguments.
    UvMatching(const LimitFace& uv_face, const QuadPlace& place, const std::array<Vec2f, 4>& uvs);

    /// The uv that the patch has at (x, y).
    Vec2<double> interpolate(double x, double y) const;

    struct Match {
        Vec2<double> place;  ///< in the parameters of the quad
        Vec2<double> error;  ///< how far its uv is from the wanted one, absolute
        Vec2<double> du, dv; ///< derivatives of the uv by the parameters of the quad
    };
    /// Finds the place whose uv is that of (x, y). May be outside of the face where that is bicubic.
    Match match(double x, double y) const;
    /// The same on side k at s of its length, without leaving the side: only along it the uv is matched.
    Match match_on_side(size_t k, double s) const;

    /// How far the uv at point `place` of side k is from the one that the patch has at point s of it.
    Vec2<double> measure_on_side(size_t k, double s, double place) const;

  private:
    Match evaluate(const Vec2<double>& at, const Vec2<double>& wanted) const;

    const LimitFace& uv_face_;
    const QuadPlace& place_;
    std::array<Vec2<double>, 4> uvs_;
};

/// Point s of side k of the unit square.
Vec2<double> find_place_on_side(size_t k, double s);
/// The point of side k beside a place, as s.
double find_place_along_side(size_t k, const Vec2<double>& place);

} // namespace relief
