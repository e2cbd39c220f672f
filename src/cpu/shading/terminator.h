// Where shadow rays start that a coarse triangle hides from light which its smooth surface gets.
#pragma once

#include "cpu/tracer.h"

namespace relief::cpu {

/// Light that falls upon a point.
struct FallingLight {
    Vec3f direction;        ///< to it, unit length
    Vec3f geometric_normal; ///< of the point, on the viewer's side
};

/// How far above the point, along the geometric normal, the smooth surface lies from which the light is seen
/// (formulas/terminator.h); 0: it comes from above the triangle, and from above the patch that is displaced,
/// or from below what is smooth.
float find_light_lift(const PreparedScene& scene, const TraceHit& hit, const SurfacePoint& point,
                      const FallingLight& light, PatchSamplesCache& patches);

} // namespace relief::cpu
