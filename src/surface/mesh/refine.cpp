#include <algorithm>
#include <array>
#include <compare>
#include <numeric>
#include <span>

#include "math/vec.h"
#include "surface/mesh/polygons.h"

namespace relief {

namespace {

/// Index of the new point in the middle of each corner's edge; one for both directions of an edge.
std::vector<uint32_t> add_edge_points(const Polygons& polygons, std::vector<Vec3f>& positions) {
    struct Edge {
        uint64_t key;
        uint32_t corner;
        auto operator<=>(const Edge&) const = default;
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
    std::sort(edges.begin(), edges.end());
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

/// Means of what the corners of a face bring to their frames.
class FrameBlender {
  public:
    FrameBlender(const Polygons& source, Polygons& target) : source_(source), target_(target) {}

    /// Adds the four corners of a quad, which is one of `size` of the face that starts at `start`.
    void add_quad(uint32_t start, uint32_t size, uint32_t k) {
        const uint32_t corner = start + k, next = start + (k + 1) % size,
                       previous = start + (k + size - 1) % size;
        face_.resize(size);
        std::iota(face_.begin(), face_.end(), start);
        add(std::array{corner}), add(std::array{corner, next}), add(face_), add(std::array{previous, corner});
    }

  private:
    void add(std::span<const uint32_t> corners) {
        if (!source_.normals.empty()) {
            Vec3f sum{};
            for (const uint32_t corner : corners) sum += source_.normals[corner];
            target_.normals.push_back(corners.size() == 1 ? sum : normalize(sum));
        }
        if (!source_.tangents.empty()) target_.tangents.push_back(blend_tangents(corners));
        if (source_.bitangents.empty()) return;
        Vec3f sum{};
        for (const uint32_t corner : corners) sum += source_.bitangents[corner];
        target_.bitangents.push_back(sum / float(corners.size()));
    }

    std::array<float, 4> blend_tangents(std::span<const uint32_t> corners) const {
        if (corners.size() == 1) return source_.tangents[corners[0]];
        Vec3f sum{};
        float sign = 0;
        for (const uint32_t corner : corners) {
            const std::array<float, 4>& tangent = source_.tangents[corner];
            sum += Vec3f{tangent[0], tangent[1], tangent[2]};
            sign += tangent[3];
        }
        // Derivatives keep their lengths.
        sum = source_.bitangents.empty() ? normalize(sum) : sum / float(corners.size());
        return {sum.x, sum.y, sum.z, sign < 0 ? -1.0f : 1.0f};
    }

    const Polygons& source_;
    Polygons& target_;
    std::vector<uint32_t> face_;
};

/// Uvs of the corners of the quads that each face becomes.
std::vector<Vec2f> refine_uvs(const Polygons& polygons, const std::vector<Vec2f>& uvs) {
    std::vector<Vec2f> result;
    for (uint32_t face = 0; face < polygons.face_count() && !uvs.empty(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        Vec2f middle{};
        for (uint32_t k = start; k < start + size; ++k) middle = middle + uvs[k];
        middle = {middle.x / float(size), middle.y / float(size)};
        for (uint32_t k = 0; k < size; ++k) {
            const Vec2f &uv = uvs[start + k], &next = uvs[start + (k + 1) % size],
                        &previous = uvs[start + (k + size - 1) % size];
            result.insert(result.end(), {uv, (uv + next) * 0.5f, middle, (previous + uv) * 0.5f});
        }
    }
    return result;
}

} // namespace

Polygons refine_to_quads(const Polygons& polygons) {
    Polygons result;
    result.where = polygons.where;
    result.positions = polygons.positions;
    const std::vector<uint32_t> edge_points = add_edge_points(polygons, result.positions);
    FrameBlender frames(polygons, result);
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        Vec3f middle{};
        for (uint32_t k = start; k < start + size; ++k) middle += polygons.positions[polygons.points[k]];
        const uint32_t face_point = uint32_t(result.positions.size());
        result.positions.push_back(middle / float(size));
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t corner = start + k, previous = start + (k + size - 1) % size;
            result.starts.push_back(uint32_t(result.points.size()));
            result.points.insert(result.points.end(), {polygons.points[corner], edge_points[corner],
                                                       face_point, edge_points[previous]});
            result.source_faces.push_back(polygons.source_faces[face]);
            frames.add_quad(start, size, k);
        }
    }
    result.uvs = refine_uvs(polygons, polygons.uvs);
    for (const CornerUvs& set : polygons.further_uvs)
        result.further_uvs.push_back({set.number, refine_uvs(polygons, set.uvs)});
    result.starts.push_back(uint32_t(result.points.size()));
    return result;
}

} // namespace relief
