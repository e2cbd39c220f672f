// Outlines of faces in the uv plane, curved where they bound an island.
#pragma once

#include <functional>
#include <span>

#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// Visits each face of a mesh that is not refined with the limit uvs around it, of the mesh's own set: its
/// corners, and points between them on sides that are no side of another face with the same uvs.
void visit_limit_outlines(const SubdivisionMesh& mesh,
                          const std::function<void(std::span<const Vec2f>)>& visit);

} // namespace relief
