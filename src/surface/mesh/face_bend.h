// How far positions, normals and uvs of a face are from linear along its two directions.
#pragma once

#include <array>
#include <optional>

#include "surface/mesh/cage.h"
#include "surface/mesh/limit_face.h"

namespace relief {

/// Largest distances from the values interpolated between the ends of lines across a whole face, or part of a
/// polygon. Where the face is smooth, a line that crosses a fraction s of it is s^2 as far away.
struct FaceBend {
    std::array<double, 2> position{}; ///< off the surface, or off sharp edges, along u and along v
    std::array<double, 2> normal{},
        tangent{};                    ///< of the unit normal, and of the direction of growing u of uvs
    std::array<Vec2<double>, 2> uv{}; ///< per coordinate
    double position_twist = 0, normal_twist = 0, tangent_twist = 0;
    Vec2<double> uv_twist{};
    double stretch = 0; ///< largest length per uv
};

/// Measures a face, or part `part` of a polygon, at 4 x 4 places. `uvs` may be null: they are bilinear.
/// `positions` may be null: then only uvs are measured. is_sharp: one per side.
FaceBend measure_bend(const LimitFace* positions, const LimitFace* uvs, uint32_t part,
                      const std::array<bool, 4>& is_sharp);

/// Distances along the way `step` across the face.
struct BendAlong {
    double position, normal, tangent;
    Vec2<double> uv;
};
BendAlong find_bend_along(const FaceBend& bend, const Vec2<double>& step);

} // namespace relief
