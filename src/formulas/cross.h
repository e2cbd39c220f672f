// Cross product in which every operation rounds once: that of parallel vectors is exactly zero, as it need
// not be by cross() of GLSL, whose operations a device may fuse.
#if !defined(RELIEF_CROSS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_CROSS_H
#endif
#include "formulas/begin.h"

FN Vec3 cross_exact(const Vec3 a, const Vec3 b) {
    EXACT Float x = a.y * b.z - a.z * b.y;
    EXACT Float y = a.z * b.x - a.x * b.z;
    EXACT Float z = a.x * b.y - a.y * b.x;
    Vec3 r = {x, y, z};
    return r;
}

#include "formulas/end.h"
#endif
