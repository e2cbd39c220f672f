// Tangents as bakers agree on them: MikkTSpace (Mikkelsen 2008, Simulation of Wrinkled Surfaces Revisited).
#pragma once

#include <span>

#include "surface/mesh/polygons.h"

namespace relief {

/// Fills `polygons.tangents`, and with relative lengths `polygons.bitangents`: corners of equal point, normal
/// and uv whose triangles join at their edges and turn their uvs the same way share the mean of the
/// directions of growing u, weighted by angles in the plane of the normal; quads count as the two triangles
/// on either side of their shorter diagonal in uv. Zero where no triangle tells. Faces are triangles and
/// quads. `point_normals` holds unit normals, one a position; empty: those are `polygons.normals`.
void add_mikk_tangents(Polygons& polygons, std::span<const Vec3<double>> point_normals, FrameLengths lengths);

} // namespace relief
