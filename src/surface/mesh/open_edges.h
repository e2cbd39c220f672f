// Edges of a mesh that only one face has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace relief {

struct OpenEdge {
    uint32_t first, second; ///< points, in the order in which the face has them
    uint32_t face;
    uint32_t corner; ///< of the first point, counted over all faces
};

/// Lists them by corner. `points`: one per corner, face after face; repeated ones make no edge.
std::vector<OpenEdge> list_open_edges(std::span<const uint32_t> face_sizes, std::span<const uint32_t> points,
                                      size_t point_count);

} // namespace relief
