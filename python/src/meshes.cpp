#include "meshes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.h"
#include "exit_gate.h"
#include "relief/error.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

/// Read with the GIL, copied without.
struct GivenArrays {
    template <class Array> static std::optional<Array> find(const nb::dict& arrays, const char* name) {
        if (!arrays.contains(name)) return std::nullopt;
        return nb::cast<Array>(arrays[name]);
    }
    explicit GivenArrays(const nb::dict& arrays)
        : positions(find<Array2<float>>(arrays, "positions")),
          sizes(find<Array1<uint32_t>>(arrays, "sizes")),
          corners(find<Array1<uint32_t>>(arrays, "corners")),
          uvs(find<Array2<float>>(arrays, "uvs")),
          uv_indices(find<Array1<uint32_t>>(arrays, "uv_indices")),
          normals(find<Array2<float>>(arrays, "normals")),
          normal_indices(find<Array1<uint32_t>>(arrays, "normal_indices")),
          tangents(find<Array2<float>>(arrays, "tangents")),
          creases(find<Array2<uint32_t>>(arrays, "creases")),
          sharpness(find<Array1<float>>(arrays, "sharpness")),
          uv_set(find<int>(arrays, "uv_set").value_or(0)) {
        if (!arrays.contains("further_uvs")) return;
        for (const auto& [number, set] : nb::cast<nb::dict>(arrays["further_uvs"])) {
            const auto values = nb::cast<nb::tuple>(set);
            Set& given = further_uvs.emplace_back();
            given.number = nb::cast<int>(number);
            given.uvs = nb::cast<Array2<float>>(values[0]);
            if (!values[1].is_none()) given.indices = nb::cast<Array1<uint32_t>>(values[1]);
        }
    }

    struct Set {
        int number = 0;
        std::optional<Array2<float>> uvs;
        std::optional<Array1<uint32_t>> indices;
    };

    std::optional<Array2<float>> positions;
    std::optional<Array1<uint32_t>> sizes, corners;
    std::optional<Array2<float>> uvs;
    std::optional<Array1<uint32_t>> uv_indices;
    std::optional<Array2<float>> normals;
    std::optional<Array1<uint32_t>> normal_indices;
    std::optional<Array2<float>> tangents;
    std::optional<Array2<uint32_t>> creases;
    std::optional<Array1<float>> sharpness;
    int uv_set;
    std::vector<Set> further_uvs;
};

template <class Element, class Array> std::vector<Element> copy(const std::optional<Array>& array) {
    return array ? copy_array<Element>(*array) : std::vector<Element>();
}

/// One uv a corner of a mesh to uvs with indices. Only those of one position are compared, so that islands
/// which happen to have a uv in common stay apart.
void weld_uvs(std::span<const Vec2f> corner_uvs, const Mesh& mesh, std::vector<Vec2f>& uvs,
              std::vector<uint32_t>& indices) {
    std::vector<uint32_t> newest(mesh.positions.size(), kNoIndex), older;
    indices.resize(corner_uvs.size());
    for (size_t corner = 0; corner < corner_uvs.size(); ++corner) {
        // Python has checked them, but another of its threads may have written to the array since.
        if (mesh.position_indices.at(corner) >= newest.size())
            throw Error(ErrorKind::bad_input, {"an index is out of range", "faces", ""});
        uint32_t& head = newest[mesh.position_indices[corner]];
        uint32_t found = head;
        while (found != kNoIndex && !(uvs[found] == corner_uvs[corner])) found = older[found];
        if (found == kNoIndex) {
            found = uint32_t(uvs.size());
            uvs.push_back(corner_uvs[corner]);
            older.push_back(head);
            head = found;
        }
        indices[corner] = found;
    }
}

/// `given`: one uv a corner where there are no indices yet.
void set_uvs(std::vector<Vec2f> given, const Mesh& mesh, std::vector<Vec2f>& uvs,
             std::vector<uint32_t>& indices) {
    if (!given.empty() && indices.empty())
        weld_uvs(given, mesh, uvs, indices);
    else
        uvs = std::move(given);
}

std::vector<uint32_t> count_up(size_t count) {
    std::vector<uint32_t> indices(count);
    for (size_t k = 0; k < count; ++k) indices[k] = uint32_t(k);
    return indices;
}

} // namespace

Mesh make_mesh(const nb::dict& arrays) {
    const GivenArrays given(arrays);
    const GateVisit visit;
    const nb::gil_scoped_release release;
    Mesh mesh;
    mesh.positions = copy<Vec3f>(given.positions);
    mesh.face_sizes = copy<uint32_t>(given.sizes);
    mesh.position_indices = copy<uint32_t>(given.corners);
    mesh.uv_set = given.uv_set;
    mesh.uv_indices = copy<uint32_t>(given.uv_indices);
    set_uvs(copy<Vec2f>(given.uvs), mesh, mesh.uvs, mesh.uv_indices);
    for (const GivenArrays::Set& further : given.further_uvs) {
        UvSet& set = mesh.further_uvs.emplace_back();
        set.number = further.number;
        set.indices = copy<uint32_t>(further.indices);
        set_uvs(copy<Vec2f>(further.uvs), mesh, set.uvs, set.indices);
    }
    mesh.normals = copy<Vec3f>(given.normals);
    mesh.normal_indices = copy<uint32_t>(given.normal_indices);
    if (!mesh.normals.empty() && mesh.normal_indices.empty())
        mesh.normal_indices = count_up(mesh.normals.size());
    mesh.tangents = copy<std::array<float, 4>>(given.tangents);
    const auto edges = copy<std::array<uint32_t, 2>>(given.creases);
    const auto sharpness = copy<float>(given.sharpness);
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
    if (mesh.uv_set != 0) arrays["uv_set"] = mesh.uv_set;
    nb::dict further_uvs;
    for (UvSet& set : mesh.further_uvs) {
        const size_t count = set.uvs.size(), corners = set.indices.size();
        further_uvs[nb::int_(set.number)] =
            nb::make_tuple(make_array<float>(std::move(set.uvs), {count, 2}),
                           make_array<uint32_t>(std::move(set.indices), {corners}));
    }
    if (further_uvs.size() > 0) arrays["further_uvs"] = further_uvs;
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
