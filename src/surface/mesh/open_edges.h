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

/// Calls `visit(face, corner, first point, second point)` for each edge of each face.
template <class Visit>
void visit_face_edges(std::span<const uint32_t> face_sizes, std::span<const uint32_t> points,
                      const Visit& visit) {
    uint32_t begin = 0;
    for (uint32_t face = 0; face < face_sizes.size(); ++face) {
        const uint32_t size = face_sizes[face];
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t first = points[begin + k], second = points[begin + (k + 1 == size ? 0 : k + 1)];
            if (first != second) visit(face, begin + k, first, second);
        }
        begin += size;
    }
}

} // namespace relief
