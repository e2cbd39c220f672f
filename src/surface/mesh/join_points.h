// Points of a mesh that are one: at equal positions, and where open edges lie on each other up to rounding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

struct JoinedPoints {
    std::vector<uint32_t> representatives; ///< for each point the one that it has become
    size_t moved_points = 0;               ///< points whose representative is at another position
    size_t joined_edges = 0;               ///< open edges that have become part of a shared one
    float farthest = 0;                    ///< largest distance between ends that were joined, along an axis
};

/// First point at the same position, for each point.
std::vector<uint32_t> find_equal_points(const std::vector<Vec3f>& positions);

/// Joins equal points, then open edges whose ends are within Mesh::weld of each other. Faces that fold back
/// onto each other stay apart, and no two points of a face are joined. The indices of the mesh must be valid.
JoinedPoints join_points(const Mesh& mesh);

/// Open edges that stay apart although they lie on each other within 1e-5 of the size of the mesh.
struct NearEdges {
    size_t count = 0;
    float weld = 0; ///< Mesh::weld that joins them
};

/// Finds none where Mesh::weld is 0. The indices of the mesh must be valid.
NearEdges find_near_edges(const Mesh& mesh);

/// For a warning, with the remedy.
std::string describe_near_edges(const NearEdges& edges);

} // namespace relief
