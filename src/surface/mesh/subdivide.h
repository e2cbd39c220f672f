// The smooth base of a mesh: quads on the limit surface, with its normals and bicubic patches.
#pragma once

#include <vector>

#include "surface/mesh/polygons.h"
#include "surface/patch/surface.h"

namespace relief {

struct SmoothBase {
    /// Quads on the limit surface, with its normals, each side of a crease its own.
    Polygons polygons;
    std::vector<Vec3f> point_normals;    ///< one a point: the mean of the sides; empty without a limit normal
    std::vector<InnerControls> controls; ///< one a face; empty: bilinear patches
};

enum class BasePatches { bilinear, bicubic };

/// Subdivides by `subdivision`, whose scheme is not `none`. Bilinear: neither normals nor controls. Throws
/// bad_input for meshes that cannot be subdivided, out_of_memory where the patches would not fit.
SmoothBase subdivide(const Polygons& polygons, const Subdivision& subdivision, BasePatches patches);

} // namespace relief
