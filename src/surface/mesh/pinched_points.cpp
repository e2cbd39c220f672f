#include "surface/mesh/pinched_points.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "surface/mesh/open_edges.h"
#include "surface/mesh/point_sets.h"

namespace relief {

namespace {

/// An edge of a face: between two representatives, and the points of the mesh that stand there.
struct JoinedEdge {
    uint32_t low, high;
    uint32_t low_point, high_point;

    friend bool operator<(const JoinedEdge& a, const JoinedEdge& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
    }
};

/// Representatives that stand for other points too.
std::vector<bool> mark_shared(const std::vector<uint32_t>& representatives) {
    std::vector<bool> is_shared(representatives.size());
    for (uint32_t point = 0; point < representatives.size(); ++point)
        if (representatives[point] != point) is_shared[representatives[point]] = true;
    return is_shared;
}

/// Edges at representatives that stand for other points too.
std::vector<JoinedEdge> list_edges(const Mesh& mesh, const std::vector<uint32_t>& representatives) {
    const std::vector<bool> is_shared = mark_shared(representatives);
    std::vector<JoinedEdge> edges;
    visit_face_edges(mesh.face_sizes, mesh.position_indices,
                     [&](uint32_t, uint32_t, uint32_t first, uint32_t second) {
                         if (representatives[first] > representatives[second]) std::swap(first, second);
                         const uint32_t low = representatives[first], high = representatives[second];
                         if (is_shared[low] || is_shared[high]) edges.push_back({low, high, first, second});
                     });
    std::sort(edges.begin(), edges.end());
    return edges;
}

} // namespace

void split_pinched_points(const Mesh& mesh, std::vector<uint32_t>& representatives) {
    const std::vector<JoinedEdge> edges = list_edges(mesh, representatives);
    if (edges.empty()) return;
    std::vector<uint32_t> numbers(representatives.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    PointSets sets(std::move(numbers));
    for (size_t k = 0; k < edges.size(); ++k) {
        const JoinedEdge& edge = edges[k];
        if (edge.low == edge.high) { // without length: its ends are one corner of the face
            sets.join(edge.low_point, edge.high_point);
        } else if (k > 0 && !(edges[k - 1] < edge)) {
            sets.join(edges[k - 1].low_point, edge.low_point);
            sets.join(edges[k - 1].high_point, edge.high_point);
        }
    }
    std::vector<bool> has_faces(representatives.size());
    for (const uint32_t point : mesh.position_indices) has_faces[point] = true;
    for (uint32_t point = 0; point < representatives.size(); ++point)
        representatives[point] = sets.find(has_faces[point] ? point : representatives[point]);
}

} // namespace relief
