// A Catmull-Clark cage cut into quads only where patches of whole faces would be too far from the limit
// surface.
#pragma once

#include "surface/mesh/base_needs.h"
#include "surface/mesh/polygons.h"
#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// Cuts the faces of a mesh that is not refined. With bicubic patches a face whose neighbourhood is regular
/// stays whole unless its uvs or, with displacements in tangent space, its frames are curved so much that the
/// displaced surface would be further away than the tolerance; other faces also where the fitted patch would
/// be. With bilinear ones quads are cut until they lie within the tolerance. Throws out_of_memory where the
/// quads would not fit.
/// `reserve` says for which other tolerances the result would be the same.
RefinedMesh refine_adaptively(const SubdivisionMesh& mesh, const Polygons& polygons, const BaseNeeds& needs,
                              BaseReserve& reserve);

} // namespace relief
