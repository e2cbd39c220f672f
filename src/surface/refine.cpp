#include <algorithm>

#include "math/vec.h"
#include "surface/polygons.h"

namespace relief {

namespace {

/// Index of the new point in the middle of each corner's edge; one for both directions of an edge.
std::vector<uint32_t> add_edge_points(const Polygons& polygons, std::vector<Vec3f>& positions) {
    struct Edge {
        uint64_t key;
        uint32_t corner;
    };
    std::vector<Edge> edges;
    edges.reserve(polygons.points.size());
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        for (uint32_t k = 0; k < size; ++k) {
            const uint64_t a = polygons.points[start + k], b = polygons.points[start + (k + 1) % size];
            edges.push_back({std::min(a, b) << 32 | std::max(a, b), start + k});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.key != b.key ? a.key < b.key : a.corner < b.corner;
    });
    std::vector<uint32_t> result(edges.size());
    for (size_t k = 0; k < edges.size(); ++k) {
        if (k == 0 || edges[k].key != edges[k - 1].key) {
            const Vec3f& a = polygons.positions[edges[k].key >> 32];
            const Vec3f& b = polygons.positions[edges[k].key & 0xffffffffu];
            positions.push_back((a + b) * 0.5f);
        }
        result[edges[k].corner] = uint32_t(positions.size() - 1);
    }
    return result;
}

} // namespace

Polygons refine_to_quads(const Polygons& polygons) {
    Polygons result;
    result.where = polygons.where;
    result.positions = polygons.positions;
    const std::vector<uint32_t> edge_points = add_edge_points(polygons, result.positions);
    const bool has_uvs = !polygons.uvs.empty();
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        Vec3f middle{};
        Vec2f middle_uv{};
        for (uint32_t k = start; k < start + size; ++k) {
            middle += polygons.positions[polygons.points[k]];
            if (has_uvs) middle_uv = middle_uv + polygons.uvs[k];
        }
        const uint32_t face_point = uint32_t(result.positions.size());
        result.positions.push_back(middle / float(size));
        middle_uv = {middle_uv.x / float(size), middle_uv.y / float(size)};
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t corner = start + k, previous = start + (k + size - 1) % size;
            result.starts.push_back(uint32_t(result.points.size()));
            result.points.insert(result.points.end(), {polygons.points[corner], edge_points[corner],
                                                       face_point, edge_points[previous]});
            result.source_faces.push_back(polygons.source_faces[face]);
            if (!has_uvs) continue;
            const Vec2f &uv = polygons.uvs[corner], &next_uv = polygons.uvs[start + (k + 1) % size];
            result.uvs.insert(result.uvs.end(),
                              {uv, (uv + next_uv) * 0.5f, middle_uv, (polygons.uvs[previous] + uv) * 0.5f});
        }
    }
    result.starts.push_back(uint32_t(result.points.size()));
    return result;
}

} // namespace relief
