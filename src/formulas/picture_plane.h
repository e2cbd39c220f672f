// The image plane at distance 1 from a camera.
#if !defined(RELIEF_PICTURE_PLANE_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_PICTURE_PLANE_H
#endif
#include "formulas/begin.h"

/// From the eye to the point `pixel` of the picture; `corner`, `step_x` and `step_y` as in CameraFrame.
FN Vec3 find_picture_point(const Vec3 corner, const Vec3 step_x, const Vec3 step_y, const Vec2 pixel) {
    return corner + step_x * pixel.x + step_y * pixel.y;
}

#include "formulas/end.h"
#endif
