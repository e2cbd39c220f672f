// Points of displaced surfaces, near enough to frame a picture with.
#pragma once

#include <functional>

#include "relief/scene.h"

namespace relief {

using VisitPoint = std::function<void(const Vec3f&)>;

/// Calls `visit` for the corners of all faces, then with a map for samples spread evenly over them: displaced
/// by the nearest texel, about `count` of them or one a face. In the space of the object; displacements of
/// world space are turned into it by `object_from_world`.
void visit_corners(const Mesh& mesh, const VisitPoint& visit);
void visit_displaced(const Mesh& mesh, const Displacement& map, const Affine& object_from_world, double count,
                     const VisitPoint& visit);

/// Twice the sum of the area vectors of all faces.
Vec3f sum_area_vectors(const Mesh& mesh);

} // namespace relief
