#include "meshes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arrays.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

template <class Element, class Array>
std::vector<Element> get_array(const nb::dict& arrays, const char* name) {
    if (!arrays.contains(name)) return {};
    return copy_array<Element>(nb::cast<Array>(arrays[name]));
}

/// One uv a corner to uvs with indices. Only those of one position are compared, so that islands which happen
/// to have a uv in common stay apart.
void weld_uvs(std::span<const Vec2f> corner_uvs, Mesh& mesh) {
    std::vector<uint32_t> newest(mesh.positions.size(), kNoIndex), older;
    mesh.uv_indices.resize(corner_uvs.size());
    for (size_t corner = 0; corner < corner_uvs.size(); ++corner) {
        uint32_t& head = newest[mesh.position_indices[corner]];
        uint32_t found = head;
        while (found != kNoIndex && !(mesh.uvs[found] == corner_uvs[corner])) found = older[found];
        if (found == kNoIndex) {
            found = uint32_t(mesh.uvs.size());
            mesh.uvs.push_back(corner_uvs[corner]);
            older.push_back(head);
            head = found;
        }
        mesh.uv_indices[corner] = found;
    }
}

std::vector<uint32_t> count_up(size_t count) {
    std::vector<uint32_t> indices(count);
    for (size_t k = 0; k < count; ++k) indices[k] = uint32_t(k);
    return indices;
}

} // namespace

Mesh make_mesh(const nb::dict& arrays) {
    Mesh mesh;
    mesh.positions = get_array<Vec3f, Array2<float>>(arrays, "positions");
    mesh.face_sizes = get_array<uint32_t, Array1<uint32_t>>(arrays, "sizes");
    mesh.position_indices = get_array<uint32_t, Array1<uint32_t>>(arrays, "corners");
    std::vector<Vec2f> uvs = get_array<Vec2f, Array2<float>>(arrays, "uvs");
    mesh.uv_indices = get_array<uint32_t, Array1<uint32_t>>(arrays, "uv_indices");
    if (!uvs.empty() && mesh.uv_indices.empty())
        weld_uvs(uvs, mesh);
    else
        mesh.uvs = std::move(uvs);
    mesh.normals = get_array<Vec3f, Array2<float>>(arrays, "normals");
    mesh.normal_indices = get_array<uint32_t, Array1<uint32_t>>(arrays, "normal_indices");
    if (!mesh.normals.empty() && mesh.normal_indices.empty())
        mesh.normal_indices = count_up(mesh.normals.size());
    mesh.tangents = get_array<std::array<float, 4>, Array2<float>>(arrays, "tangents");
    const auto edges = get_array<std::array<uint32_t, 2>, Array2<uint32_t>>(arrays, "creases");
    const auto sharpness = get_array<float, Array1<float>>(arrays, "sharpness");
    for (size_t k = 0; k < std::min(edges.size(), sharpness.size()); ++k)
        mesh.creases.push_back({edges[k][0], edges[k][1], sharpness[k]});
    return mesh;
}

nb::dict make_mesh_arrays(Mesh&& mesh) {
    nb::dict arrays;
    const auto add = [&]<class T>(const char* name, auto&& values, size_t width, T) {
        if (values.empty()) return;
        const size_t count = values.size();
        if (width > 1)
            arrays[name] = make_array<T>(std::move(values), {count, width});
        else
            arrays[name] = make_array<T>(std::move(values), {count});
    };
    add("positions", std::move(mesh.positions), 3, float());
    add("sizes", std::move(mesh.face_sizes), 1, uint32_t());
    add("corners", std::move(mesh.position_indices), 1, uint32_t());
    add("uvs", std::move(mesh.uvs), 2, float());
    add("uv_indices", std::move(mesh.uv_indices), 1, uint32_t());
    add("normals", std::move(mesh.normals), 3, float());
    add("normal_indices", std::move(mesh.normal_indices), 1, uint32_t());
    add("tangents", std::move(mesh.tangents), 4, float());
    std::vector<std::array<uint32_t, 2>> edges;
    std::vector<float> sharpness;
    for (const Crease& crease : mesh.creases) {
        edges.push_back({crease.first, crease.second});
        sharpness.push_back(crease.sharpness);
    }
    add("creases", std::move(edges), 2, uint32_t());
    add("sharpness", std::move(sharpness), 1, float());
    return arrays;
}

} // namespace relief::python
