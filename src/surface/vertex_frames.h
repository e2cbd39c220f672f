// Smooth normals and tangents at the vertices of a displaced surface.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/surface.h"

namespace relief {

/// Fills `surface.frames`: normals of the joined points, weighted by the angle of each corner (Thuermer and
/// Wuethrich 1998); for a tangent map also the directions of growing u of each vertex, weighted likewise
/// (after MikkTSpace, Mikkelsen 2008). `handedness` holds +1 or -1 for each vertex; `normals` holds unit
/// normals of the vertices that are known already, the same for all copies of a point, or is empty.
void compute_vertex_frames(Surface& surface, const std::vector<float>& handedness,
                           const std::vector<Vec3f>& normals);

/// Signed area of a patch in the plane of its uvs; negative where the map is mirrored.
double compute_uv_area(const std::array<Vec2f, 4>& uvs);

} // namespace relief
