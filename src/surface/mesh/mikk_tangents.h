// Tangents as bakers agree on them: MikkTSpace (Mikkelsen 2008, Simulation of Wrinkled Surfaces Revisited).
#pragma once

#include <span>

#include "surface/mesh/polygons.h"

namespace relief {

/// Fills `polygons.tangents`, with relative lengths `polygons.bitangents`: corners of equal point, normal and
/// uv whose triangles join and turn alike share the angle-weighted mean direction of growing u; quads count
/// as two triangles along the shorter uv diagonal. Zero where no triangle tells. Triangles and quads only.
/// `point_normals`: unit, one a position; empty: `polygons.normals`.
void add_mikk_tangents(Polygons& polygons, std::span<const Vec3<double>> point_normals, FrameLengths lengths);

} // namespace relief
