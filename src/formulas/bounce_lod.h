// From where on a bounce ray sees a coarser surface than the vertex that it leaves: by the width of its cone,
// which the density of its direction gives (Suykens and Willems 2001, Path differentials and applications).
#ifndef RELIEF_BOUNCE_LOD_H
#define RELIEF_BOUNCE_LOD_H
#include "formulas/constants.h"

#include "formulas/begin.h"

const uint kBounceBias = 3u; ///< LOD bias of the far part of a bounce ray

/// Width at distance 1 of a ray cone with density 1 per steradian; a pixel's samples together see finer.
const float kBounceCone = 0.0625f;

/// Automatic levels: cells as wide as pixels are at their distance from the camera.
struct BounceLod {
    Vec3 camera;      ///< world space
    float cell_angle; ///< width of a cell at distance 1; 0: all parts of all rays see one surface
};

/// Distance at which the cone of a bounce ray is as wide as the cells of M_(kBounceBias) around its origin,
/// which it sees from there on. Infinity: nowhere. `lod_bias`: of its surface; `pdf`: per steradian.
FN float find_coarse_distance(const BounceLod lod, const Vec3 origin, const uint lod_bias, const float pdf) {
    if (!(lod.cell_angle > 0.0f) || lod_bias != 0u || !(pdf > 0.0f)) return make_infinity();
    float cell = lod.cell_angle * length(origin - lod.camera) * float(1u << kBounceBias);
    return cell * sqrt(pdf) / kBounceCone;
}

#include "formulas/end.h"
#endif
