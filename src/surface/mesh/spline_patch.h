// Uniform bicubic B-spline patches, which Catmull-Clark surfaces consist of.
#pragma once

#include <array>

#include "math/vec_double.h"

namespace relief {

/// Limit value and derivatives in the parameters of a face or part.
struct LimitSample {
    Vec3d position, du, dv;
    Vec3d duv{}; ///< only if it was asked for
};

/// Control points [column along u][row along v] of a patch; the corners of the face are near (1, 1), (2, 1),
/// (2, 2) and (1, 2).
using SplineControls = std::array<std::array<Vec3d, 4>, 4>;

LimitSample evaluate_spline(const SplineControls& controls, double u, double v, bool has_twist);
Vec3d evaluate_spline_position(const SplineControls& controls, double u, double v);

} // namespace relief
