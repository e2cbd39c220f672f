// The base of a displaced surface with what its frames are made from.
#pragma once

#include <vector>

#include "surface/mesh/subdivide.h"
#include "surface/mesh/vertex_frames.h"

namespace relief {

struct FramedBase {
    /// Normals of the file, or empty: those of the points; tangents where corners bring them.
    SmoothBase base;
    std::vector<Vec3d> point_normals; ///< unit, one a position
};

/// Quads, smooth where the mesh says so, with the normals and tangents that `displacement` asks for.
/// `polygons` are those of the mesh, with uvs; `base_needs` is
/// for automatic subdivision levels. MikkTSpace runs on triangles and quads as they are in the
/// mesh, or on the patches where faces have more corners or the base is smooth. Throws bad_input for missing
/// normals, and for subdivision or relative lengths with the file's frames.
FramedBase make_framed_base(Polygons polygons, const Mesh& mesh, const Displacement& displacement,
                            const BaseNeeds& base_needs);

} // namespace relief
