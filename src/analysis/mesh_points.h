// Corners of a mesh numbered by their values, however its file numbers them.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// One number a corner, the same where positions are exactly equal.
std::vector<uint32_t> number_points(const Mesh& mesh);

/// One number a corner, the same where positions and uvs are exactly equal. For meshes with uvs.
std::vector<uint32_t> number_uv_points(const Mesh& mesh);

} // namespace relief
