// The smooth base of a mesh: quads on the limit surface, with its normals and bicubic patches.
#pragma once

#include <vector>

#include "surface/mesh/base_needs.h"
#include "surface/mesh/polygons.h"
#include "surface/mesh/quad_place.h"
#include "surface/patch/surface.h"

namespace relief {

struct SmoothBase {
    /// Quads on the limit surface, with its normals, each side of a crease its own.
    Polygons polygons;
    std::vector<Vec3f> point_normals;    ///< one a point: the mean of the sides; empty without a limit normal
    std::vector<InnerControls> controls; ///< one a face; empty: bilinear patches
    std::vector<QuadPlace> places;       ///< per quad, where flat faces are cut into several; or empty
    BaseReserve reserve;                 ///< of automatic levels
};

/// Subdivides by `subdivision`, whose scheme is not `none`: to its level, or as finely as `needs` asks for
/// where the level is automatic (the scheme `bilinear` needs no level). The scheme `bilinear` makes neither
/// normals nor controls. Throws bad_input for meshes that cannot be subdivided, out_of_memory where the
/// patches would not fit.
SmoothBase subdivide(const Polygons& polygons, const Subdivision& subdivision, const BaseNeeds& needs);

} // namespace relief
