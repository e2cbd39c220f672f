// The numbers of a material that lets light through, as prepare/material_glass.h finds them. One struct for
// lanes, records and device memory.
#if !defined(RELIEF_GLASS_PARAMETERS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_GLASS_PARAMETERS_H
#endif
#include "formulas/begin.h"

// Kinds of glass, in order.
const float kSolidGlass = 0.0f; ///< a body: light is refracted
const float kRoughWall = 1.0f;  ///< a thin wall that blurs what is behind it
const float kClearWall = 2.0f;  ///< a thin wall that rays pass straight on

struct GlassParameters {
    Float weight;        ///< (0, 1]: part of the dielectric that is glass
    Float ior;           ///< of the inside over the outside, at least kLeastGlassIor
    Vec3 specular_color; ///< factor of what is reflected outside
    Vec3 tint;           ///< factor of what is refracted, at each crossing
    Vec3 depth;          ///< -log2 of what is left after a scene unit; of a wall straight through it
    Float anisotropy;    ///< [0, 1], of the roughness
    Float kind;          ///< kSolidGlass, kRoughWall or kClearWall
};

#include "formulas/end.h"
#endif
