// Faces without area: exporters and sculpting programs leave some, and no ray can hit them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "surface/mesh/polygons.h"

namespace relief {

struct DegenerateFaces {
    size_t count = 0;
    uint32_t first = 0; ///< number of a face of the mesh
};

/// False for fewer than three corners, for one that coincide and for one on a line, up to rounding.
bool has_area(std::span<const Vec3f> corners);

/// Of a mesh whose indices are valid.
DegenerateFaces find_degenerate_faces(const Mesh& mesh);

/// Removes them. What was closed stays closed: where corners lie on a line, the neighbour across the longest
/// edge takes those in between, with interpolated attributes; of several such faces in a row the last one's.
/// Throws bad_input where no face is left.
void drop_degenerate_faces(Polygons& polygons);

} // namespace relief
