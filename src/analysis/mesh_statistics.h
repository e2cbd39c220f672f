// What the faces, edges and uvs of a mesh are, for inspection.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "relief/scene.h"
#include "scene/tile_use.h"
#include "surface/mesh/join_points.h"

namespace relief {

/// Faces by corners, and edges by the faces that meet there; points that join_points() joins count as one.
struct MeshShape {
    size_t triangles = 0, quads = 0, others = 0;
    size_t open_edges = 0;              ///< of one face
    JoinedPoints joined;                ///< of edges that were open
    NearEdges near_edges;               ///< among the open ones
    size_t crowded_edges = 0;           ///< of more than two faces
    size_t turned_edges = 0;            ///< whose two faces run it the same way: one of them is inside out
    std::optional<size_t> crowded_face; ///< one that has a crowded edge
    std::optional<size_t> turned_face;  ///< one of a pair that runs an edge the same way
    std::vector<size_t> valences;       ///< points by the number of their edges
    size_t faces() const { return triangles + quads + others; }
};

struct MeshUvs {
    Vec2f low, high;
    size_t islands = 0;
    size_t mirrored_islands = 0, mirrored_faces = 0; ///< of negative area
    size_t flat_faces = 0;                           ///< of no area
    TileUse tile_use;
    double overlap = 0; ///< area that several faces share, over the area that any covers; [0, 1]
};

/// How often each index of a mesh points nowhere, and the first value of each kind that is not finite.
struct MeshFaults {
    size_t bad_indices = 0;
    std::optional<size_t> bad_position, bad_uv, bad_normal;
    bool has_bad_counts = false; ///< corners and indices differ in number, or a face has fewer than three
    bool is_sound() const {
        return bad_indices == 0 && !bad_position && !bad_uv && !bad_normal && !has_bad_counts;
    }
};

/// What of a mesh is displaced, for people: "catmark, level 2: 4 x 4 patches a quad, ...".
std::string describe_base(const Mesh& mesh);
/// What a displacement goes through, for people; `mesh` may be null. Empty in object and world space.
std::string describe_frame(const Displacement& map, const Mesh* mesh);

MeshFaults find_mesh_faults(const Mesh& mesh);

/// Both for meshes without faults only; the second with uvs.
MeshShape measure_shape(const Mesh& mesh);
MeshUvs measure_uvs(const Mesh& mesh);

/// MeshUvs::overlap alone, of a mesh of which each face has uvs, on about `most_cells` points.
double measure_uv_overlap(const Mesh& mesh, double most_cells);
inline constexpr double kMuchOverlap = 0.01; ///< more is probably not meant

} // namespace relief
