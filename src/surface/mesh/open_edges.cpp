#include "surface/mesh/open_edges.h"

#include <algorithm>
#include <utility>

namespace relief {

std::vector<OpenEdge> list_open_edges(std::span<const uint32_t> face_sizes, std::span<const uint32_t> points,
                                      size_t point_count) {
    using Edge = std::pair<uint32_t, uint32_t>; // its larger point and the corner
    std::vector<uint32_t> ends(point_count + 1);
    visit_face_edges(face_sizes, points, [&](uint32_t, uint32_t, uint32_t first, uint32_t second) {
        ++ends[std::min(first, second)];
    });
    uint32_t sum = 0;
    for (uint32_t& end : ends) sum = end = end + sum;
    std::vector<Edge> edges(sum);
    visit_face_edges(face_sizes, points, [&](uint32_t, uint32_t corner, uint32_t first, uint32_t second) {
        edges[--ends[std::min(first, second)]] = {std::max(first, second), corner};
    });
    std::vector<bool> is_open(points.size());
    for (size_t point = 0; point < point_count; ++point) {
        const auto begin = edges.begin() + ends[point], end = edges.begin() + ends[point + 1];
        std::sort(begin, end);
        for (auto edge = begin; edge < end;) {
            const auto next = std::find_if(edge, end, [&](const Edge& e) { return e.first != edge->first; });
            if (next - edge == 1) is_open[edge->second] = true;
            edge = next;
        }
    }
    std::vector<OpenEdge> result;
    visit_face_edges(face_sizes, points,
                     [&](uint32_t face, uint32_t corner, uint32_t first, uint32_t second) {
                         if (is_open[corner]) result.push_back({first, second, face, corner});
                     });
    return result;
}

} // namespace relief
