#include "scene/faces_without_uvs.h"

namespace relief {

namespace {

/// Of the face whose first corner is `first`.
bool has_uvs(const Mesh& mesh, size_t first) {
    return first < mesh.uv_indices.size() && mesh.uv_indices[first] != kNoIndex;
}

template <class Value>
void append(const std::vector<Value>& from, size_t first, size_t count, std::vector<Value>& to) {
    if (from.empty()) return;
    to.insert(to.end(), from.begin() + ptrdiff_t(first), from.begin() + ptrdiff_t(first + count));
}

} // namespace

FacesWithoutUvs find_faces_without_uvs(const Mesh& mesh) {
    FacesWithoutUvs result;
    if (mesh.uv_indices.empty()) return result;
    size_t first = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); first += mesh.face_sizes[face], ++face)
        if (!has_uvs(mesh, first) && result.count++ == 0) result.first = face;
    return result;
}

Mesh drop_faces_without_uvs(const Mesh& mesh) {
    Mesh result;
    result.name = mesh.name, result.source = mesh.source;
    result.positions = mesh.positions, result.uvs = mesh.uvs, result.normals = mesh.normals;
    result.creases = mesh.creases, result.subdivision = mesh.subdivision;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (has_uvs(mesh, first)) {
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
