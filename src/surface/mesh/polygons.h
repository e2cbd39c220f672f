// Checked polygons between the mesh of the scene and the patches: one entry a corner, attributes resolved.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// One set of uvs beside those of the mesh.
struct CornerUvs {
    int number;             ///< as UvSet::number
    std::vector<Vec2f> uvs; ///< one a corner; (0, 0) where the face has none
};

struct Polygons {
    std::string where; ///< file and mesh, for messages
    std::vector<Vec3f> positions;
    std::vector<uint32_t> starts; ///< first corner of each face, and the end of the last one
    std::vector<uint32_t> points; ///< index into positions, one a corner
    std::vector<Vec2f> uvs;       ///< one a corner, or empty; (0, 0) where the face has none
    std::vector<CornerUvs> further_uvs;
    std::vector<Vec3f> normals; ///< one a corner, or empty
    /// One a corner, or empty: direction of growing u (x, y, z) and sign of the bitangent, as in Mesh.
    std::vector<std::array<float, 4>> tangents;
    std::vector<Vec3f> bitangents; ///< one a corner, or empty; with them, `tangents` are dP/du, they dP/dv
    std::vector<uint32_t> source_faces; ///< face of the mesh
    std::vector<Crease> creases;        ///< of the mesh, between these points

    uint32_t face_count() const { return uint32_t(source_faces.size()); }
    uint32_t face_size(uint32_t face) const { return starts[face + 1] - starts[face]; }
};

enum class Welding {
    none,         ///< points stay as the mesh numbers them
    joined_points ///< points become one that join_points() joins, as exporters take them apart
};

/// Resolves and checks a mesh; drops repeated corners and faces without area (degenerate_faces.h). `uv_sets`:
/// which of its further uvs are wanted, where it has them. Throws bad_input with mesh and face: index out of
/// range, value not finite or beyond 1e18, no face left.
Polygons make_polygons(const Mesh& mesh, Welding welding, std::span<const int> uv_sets = {});

/// One linear Catmull-Clark step without smoothing: a quad per corner of every face, from it to the middles
/// of its next edge, face and previous edge. Uvs, normals and tangents are interpolated.
Polygons refine_to_quads(const Polygons& polygons);

/// Keeps triangles and convex quads; cuts other faces by ears in the plane of their Newell normal.
Polygons cut_to_triangles(const Polygons& polygons);

/// Keeps convex faces and cuts concave ones by the same ears. Edges between faces get no new points. A cut
/// between two points that another edge or cut joins gets a point in its middle, so that no two faces share
/// it by mistake. Returns `polygons` as they are where all faces are convex.
Polygons cut_concave_faces(Polygons polygons);

/// A point at a part of the way from a corner to another one of its face, in [0, 1).
struct PointOnWay {
    uint32_t point;
    float part = 0;
};

/// Appends a corner to the last face of `to`, with values interpolated between two corners of `from`.
void add_corner_between(const Polygons& from, uint32_t corner, uint32_t next, const PointOnWay& at,
                        Polygons& to);
/// Appends a corner of `from` as it is.
inline void add_corner(const Polygons& from, uint32_t corner, Polygons& to) {
    add_corner_between(from, corner, corner, {from.points[corner]}, to);
}
/// Begins a face of `to`, which comes from the same face of the mesh as `face` of `from`.
inline void begin_face(const Polygons& from, uint32_t face, Polygons& to) {
    to.starts.push_back(uint32_t(to.points.size()));
    to.source_faces.push_back(from.source_faces[face]);
}

/// Twice the area vector by Newell's method in double precision, of a face or of corners in space.
Vec3<double> compute_newell_normal(const Polygons& polygons, uint32_t face);
Vec3<double> compute_newell_normal(std::span<const Vec3f> corners);

} // namespace relief
