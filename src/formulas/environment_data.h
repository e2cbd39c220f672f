// Parameters of formulas/environment.h, uniform over all lanes.
#ifndef RELIEF_ENVIRONMENT_DATA_H
#define RELIEF_ENVIRONMENT_DATA_H
#include "formulas/begin.h"

/// Members of 4 bytes: part of the kernels' push constants.
struct EnvironmentData {
    Vec3 scale;               ///< multiplies the image; without an image the radiance
    float sin_turn, cos_turn; ///< rotation about +y
    uint cells_x, cells_y;    ///< resolution of the density
    uint texture_index;       ///< kNone: constant
};

#include "formulas/end.h"
#endif
