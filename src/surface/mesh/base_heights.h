// Heights of a smooth surface above coarse faces. The faces represent the surface; the heights are those at
// the points that cut the faces into quads.
#pragma once

#include <span>
#include <vector>

#include "surface/mesh/base_frames.h"

namespace relief {

/// Places of the quads that refine_to_quads() makes of `polygons`.
std::vector<QuadPlace> list_parts(const Polygons& polygons);

/// Heights, one a point, of the smooth surface above the faces that `framed.base.places` are on, along their
/// normals and negative below, by the planes that touch the surface at the corners of a face
/// (formulas/terminator.h); a point between two faces has the mean. Empty where all are 0, as for faces that
/// are whole quads.
std::vector<float> find_base_heights(const FramedBase& framed);

} // namespace relief
