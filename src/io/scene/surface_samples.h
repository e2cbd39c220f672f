// Points of displaced surfaces, near enough to frame a picture with.
#pragma once

#include <functional>

#include "relief/scene.h"

namespace relief {

using VisitPoint = std::function<void(const Vec3f&)>;

/// Calls `visit` for all face corners, then with a map for about `count` displaced samples, at least one a
/// face. In object space; world-space displacements are turned by `object_from_world`.
void visit_corners(const Mesh& mesh, const VisitPoint& visit);
void visit_displaced(const Mesh& mesh, const Displacement& map, const Affine& object_from_world, double count,
                     const VisitPoint& visit);

/// Twice the sum of the area vectors of all faces.
Vec3f sum_area_vectors(const Mesh& mesh);

} // namespace relief
