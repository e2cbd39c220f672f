// Corners of a mesh numbered by their values, however its file numbers them.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"
#include "surface/mesh/join_points.h"

namespace relief {

/// One number per corner, the same where points are joined.
std::vector<uint32_t> number_points(const Mesh& mesh, const JoinedPoints& joined);

/// One number per corner, the same where number_points() has the same and uvs are equal. For meshes with uvs.
std::vector<uint32_t> number_uv_points(const Mesh& mesh);

} // namespace relief
