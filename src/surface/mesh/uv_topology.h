// Which corners of polygons have one uv: what face-varying topology is made from.
#pragma once

#include <vector>

#include "surface/mesh/polygons.h"

namespace relief {

/// Corners of one point whose uvs agree share a number.
struct UvTopology {
    std::vector<int> indices;
    std::vector<Vec2f> values;
};

/// Of `uvs`, one a corner of the polygons, or none: numbers by corner, values by number.
UvTopology join_uvs(const Polygons& polygons, const std::vector<Vec2f>& uvs);

} // namespace relief
