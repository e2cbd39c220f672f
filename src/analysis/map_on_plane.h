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

/// Of the first tile of a map, with `axes` in place of its own. At most a million cells are looked at, evenly
/// spread. Cells with values that are not finite are left out.
PlaneFolds measure_folds(const Displacement& map, const AxisMap& axes);

} // namespace relief
