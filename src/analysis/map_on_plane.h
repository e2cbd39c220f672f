// A displacement map on a plane, without a mesh: where the surface folds over, by the order of its channels.
#pragma once

#include "relief/scene.h"

namespace relief {

/// Share of cells between texels whose surface runs backwards as seen along the normal, and its area, both of
/// a plane two units wide, as sculpting programs have it.
struct PlaneFolds {
    double share = 0;
    double area = 0; ///< times that of the plane
};

/// Of the first tile, with `axes` in place of its own; up to a million evenly spread finite cells.
PlaneFolds measure_folds(const Displacement& map, const AxisMap& axes);

} // namespace relief
