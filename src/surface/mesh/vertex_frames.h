// Smooth normals and tangents at the vertices of a displaced surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec_double.h"
#include "surface/mesh/polygons.h"
#include "surface/patch/surface.h"

namespace relief {

/// What is known of vertices beside position and uv.
struct VertexSources {
    std::vector<uint32_t> points;               ///< one a vertex: its place in `point_normals`
    std::vector<Vec3d> point_normals;           ///< unit
    std::vector<Vec3f> normals;                 ///< one a vertex, or empty: those of the points
    std::vector<std::array<float, 4>> tangents; ///< one a vertex, or empty: made from the uvs
    std::vector<Vec3f> bitangents;              ///< see Polygons
    std::vector<float> handedness;              ///< +1 or -1 a vertex
    FrameLengths lengths = FrameLengths::absolute;
};

/// What is summed at a point: the normal of each corner between its two edges, or that of its whole face
/// (by Newell's method), as modellers and bakers do. They differ where quads are not flat.
enum class SummedNormals { corners, faces };

/// Unit normals of the points, weighted by the angle of each corner (Thuermer and Wuethrich 1998).
std::vector<Vec3d> compute_point_normals(const Polygons& polygons, SummedNormals summed);

/// Fills `surface.frames`, for a tangent map with tangents: those given, or the directions of growing u of
/// the patches' corners, weighted by their angles. With relative lengths `surface.derivatives` as well: those
/// given, or the mean of the corners' derivatives.
void compute_vertex_frames(Surface& surface, const VertexSources& sources);

/// Signed area of a patch in the plane of its uvs; negative where the map is mirrored.
double compute_uv_area(const std::array<Vec2f, 4>& uvs);

} // namespace relief
