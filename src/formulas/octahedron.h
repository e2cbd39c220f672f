// Octahedral unit vectors (Cigolle et al. 2014, A Survey of Efficient Representations).
#if !defined(RELIEF_OCTAHEDRON_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_OCTAHEDRON_H
#endif
#include "formulas/begin.h"

/// Unit vector of coordinates in [-1, 1].
FN Vec3 unfold_octahedron(const Float x, const Float y) {
    EXACT Float z = Float(1.0f) - abs(x) - abs(y);
    Float overlap = max(-z, Float(0.0f));
    EXACT Float unfolded_x = x - copy_sign(overlap, x);
    EXACT Float unfolded_y = y - copy_sign(overlap, y);
    Vec3 v = {unfolded_x, unfolded_y, z};
    return make_unit(v);
}

#include "formulas/end.h"
#endif
