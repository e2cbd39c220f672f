// What the formulas of formulas/environment.h know of the environment: the same for all lanes.
#ifndef RELIEF_ENVIRONMENT_DATA_H
#define RELIEF_ENVIRONMENT_DATA_H
#include "formulas/begin.h"

/// Members of 4 bytes: part of the kernels' push constants.
struct EnvironmentData {
    Vec3 scale;               ///< on the image; without one the radiance
    float sin_turn, cos_turn; ///< about +y
    uint cells_x, cells_y;    ///< of the density
    uint texture_index;       ///< kNone: constant
};

#include "formulas/end.h"
#endif
