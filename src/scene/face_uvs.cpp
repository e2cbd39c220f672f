#include "scene/face_uvs.h"

#include <optional>

#include "base/udim.h"

namespace relief {

namespace {

/// Of the face whose first corner is `first`.
bool has_uvs(const std::vector<uint32_t>& uv_indices, size_t first) {
    return first < uv_indices.size() && uv_indices[first] != kNoIndex;
}

template <class Value>
void append(const std::vector<Value>& from, size_t first, size_t count, std::vector<Value>& to) {
    if (from.empty()) return;
    to.insert(to.end(), from.begin() + ptrdiff_t(first), from.begin() + ptrdiff_t(first + count));
}

} // namespace

FacesWithoutUvs find_faces_without_uvs(const Mesh& mesh) {
    return find_faces_without_uvs(mesh.face_sizes, mesh.uv_indices);
}

FacesWithoutUvs find_faces_without_uvs(const std::vector<uint32_t>& face_sizes,
                                       const std::vector<uint32_t>& uv_indices) {
    FacesWithoutUvs result;
    if (uv_indices.empty()) return result;
    size_t first = 0;
    for (size_t face = 0; face < face_sizes.size(); first += face_sizes[face], ++face)
        if (!has_uvs(uv_indices, first) && result.count++ == 0) result.first = face;
    return result;
}

double compute_uv_area(const Mesh& mesh, size_t first, uint32_t size) {
    double area = 0;
    for (uint32_t k = 0; k < size && has_uvs(mesh.uv_indices, first); ++k) {
        const Vec2f& a = mesh.uvs[mesh.uv_indices[first + k]];
        const Vec2f& b = mesh.uvs[mesh.uv_indices[first + (k + 1) % size]];
        area += (double(a.x) * b.y - double(a.y) * b.x) / 2;
    }
    return area;
}

std::set<int> list_tiles(const Mesh& mesh) {
    std::set<int> tiles;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        double u = 0, v = 0;
        for (size_t k = first; k < first + size && k < mesh.uv_indices.size(); ++k)
            if (mesh.uv_indices[k] < mesh.uvs.size()) {
                u += double(mesh.uvs[mesh.uv_indices[k]].x) / size;
                v += double(mesh.uvs[mesh.uv_indices[k]].y) / size;
            }
        first += size;
        if (const std::optional<int> udim = find_udim(u, v)) tiles.insert(*udim);
    }
    return tiles;
}

Mesh drop_faces_without_uvs(const Mesh& mesh) {
    Mesh result;
    result.name = mesh.name, result.source = mesh.source;
    result.positions = mesh.positions, result.uvs = mesh.uvs, result.normals = mesh.normals;
    result.creases = mesh.creases, result.subdivision = mesh.subdivision;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (has_uvs(mesh.uv_indices, first)) {
            result.face_sizes.push_back(size);
            append(mesh.position_indices, first, size, result.position_indices);
            append(mesh.uv_indices, first, size, result.uv_indices);
            append(mesh.normal_indices, first, size, result.normal_indices);
            append(mesh.tangents, first, size, result.tangents);
        }
        first += size;
    }
    return result;
}

} // namespace relief
