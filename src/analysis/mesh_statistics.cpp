#include "analysis/mesh_statistics.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>

#include <fmt/format.h>

#include "analysis/mesh_points.h"
#include "math/vec.h"

namespace relief {

namespace {

size_t count_out_of_range(const std::vector<uint32_t>& indices, size_t size) {
    return size_t(std::ranges::count_if(indices, [size](uint32_t index) { return index >= size; }));
}

/// Uv indices that point nowhere; those of a face without uvs do not count where other faces have them.
size_t count_bad_uv_indices(const Mesh& mesh) {
    size_t bad = 0, first = 0, faces_with_uvs = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (first + size > mesh.uv_indices.size()) break;
        const auto begin = mesh.uv_indices.begin() + ptrdiff_t(first), end = begin + ptrdiff_t(size);
        if (!std::all_of(begin, end, [](uint32_t index) { return index == kNoIndex; })) {
            ++faces_with_uvs;
            bad += count_out_of_range({begin, end}, mesh.uvs.size());
        }
        first += size;
    }
    return faces_with_uvs > 0 ? bad : mesh.uv_indices.size();
}

/// One side of an edge: its two points, the smaller first.
struct HalfEdge {
    uint64_t key;
    uint32_t face;
    bool is_turned; ///< runs from the larger point to the smaller
    auto operator<=>(const HalfEdge&) const = default;
};

std::vector<HalfEdge> list_half_edges(const Mesh& mesh, const std::vector<uint32_t>& points) {
    std::vector<HalfEdge> edges;
    size_t first = 0;
    for (uint32_t face = 0; face < mesh.face_sizes.size(); ++face) {
        const uint32_t size = mesh.face_sizes[face];
        for (uint32_t k = 0; k < size; ++k) {
            const uint64_t a = points[first + k], b = points[first + (k + 1) % size];
            if (a != b) edges.push_back({std::min(a, b) << 32 | std::max(a, b), face, a > b});
        }
        first += size;
    }
    std::ranges::sort(edges);
    return edges;
}

void count_edges(const std::vector<HalfEdge>& edges, MeshShape& shape) {
    std::vector<size_t> valence_of_point;
    for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && edges[end].key == edges[begin].key;) ++end;
        for (const uint64_t point : {edges[begin].key >> 32, edges[begin].key & 0xffffffffu}) {
            if (point >= valence_of_point.size()) valence_of_point.resize(point + 1);
            ++valence_of_point[point];
        }
        if (end - begin == 1) ++shape.open_edges;
        if (end - begin > 2) {
            ++shape.crowded_edges;
            if (!shape.crowded_face) shape.crowded_face = edges[begin].face;
        }
        if (end - begin == 2 && edges[begin].is_turned == edges[begin + 1].is_turned) {
            ++shape.turned_edges;
            if (!shape.turned_face) shape.turned_face = edges[begin].face;
        }
    }
    for (const size_t valence : valence_of_point) {
        if (valence >= shape.valences.size()) shape.valences.resize(valence + 1);
        ++shape.valences[valence];
    }
}

} // namespace

std::string describe_base(const Mesh& mesh) {
    const Subdivision& subdivision = mesh.subdivision;
    if (subdivision.scheme == SubdivisionScheme::none)
        return "the mesh as it is, level 0: a map baked against another level needs that level's mesh, or "
               "subdivision";
    const int side = 1 << std::max(subdivision.level, 0);
    const std::string level =
        subdivision.level == kAutoSubdivisionLevel
            ? "level auto: patches within a tenth of a pixel of it"
            : fmt::format("level {}: {} x {} patches per quad", subdivision.level, side, side);
    return fmt::format("{}, {}; uv {}, boundary {}, {} creases {}",
                       subdivision.scheme == SubdivisionScheme::catmark ? "catmark limit surface"
                                                                        : "bilinear",
                       level, subdivision.uv == UvRule::smooth ? "smooth" : "linear",
                       subdivision.boundary == BoundaryRule::edge_only ? "edge-only" : "edge-and-corner",
                       mesh.creases.size(), subdivision.creases == CreaseRule::obey ? "obeyed" : "ignored");
}

std::string describe_frame(const Displacement& map, const Mesh* mesh) {
    const bool is_height = map.type == DisplacementType::height;
    if (!is_height && map.space != DisplacementSpace::tangent) return {};
    const bool is_smooth = mesh && mesh->subdivision.scheme != SubdivisionScheme::none;
    std::string text;
    if (map.frame == FrameKind::file)
        text = is_height ? "file: its normals"
               : mesh && !mesh->tangents.empty()
                   ? "file: its normals and tangents"
                   : "file: its normals, and tangents by MikkTSpace around them";
    else if (is_smooth)
        text = is_height                      ? "normals of the smooth base"
               : map.frame == FrameKind::mikk ? "mikk: normals of the smooth base, tangents by MikkTSpace"
                                              : "dpdu: normals of the smooth base, tangents along dP/du";
    else if (map.frame == FrameKind::mikk)
        text =
            is_height ? "mikk: mean normals of faces" : "mikk: mean normals of faces, tangents by MikkTSpace";
    else
        text = is_height ? "dpdu: mean normals of corners"
                         : "dpdu: mean normals of corners, mean tangents along dP/du";
    if (is_height) return text;
    return text + (map.lengths == FrameLengths::relative ? "; relative lengths: t and b grow with the faces"
                                                         : "; absolute lengths");
}

MeshFaults find_mesh_faults(const Mesh& mesh) {
    MeshFaults faults;
    const size_t corners = std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), size_t(0));
    const auto has_bad_count = [&](const std::vector<uint32_t>& indices) {
        return !indices.empty() && indices.size() != corners;
    };
    faults.has_bad_counts = mesh.position_indices.size() != corners || has_bad_count(mesh.uv_indices) ||
                            has_bad_count(mesh.normal_indices) ||
                            std::ranges::any_of(mesh.face_sizes, [](uint32_t size) { return size < 3; });
    faults.bad_indices = count_out_of_range(mesh.position_indices, mesh.positions.size()) +
                         count_bad_uv_indices(mesh) +
                         count_out_of_range(mesh.normal_indices, mesh.normals.size());
    const auto position = std::ranges::find_if_not(mesh.positions, is_finite);
    if (position != mesh.positions.end()) faults.bad_position = size_t(position - mesh.positions.begin());
    const auto uv = std::ranges::find_if_not(
        mesh.uvs, [](const Vec2f& value) { return std::isfinite(value.x) && std::isfinite(value.y); });
    if (uv != mesh.uvs.end()) faults.bad_uv = size_t(uv - mesh.uvs.begin());
    const auto normal = std::ranges::find_if_not(mesh.normals, is_finite);
    if (normal != mesh.normals.end()) faults.bad_normal = size_t(normal - mesh.normals.begin());
    return faults;
}

MeshShape measure_shape(const Mesh& mesh) {
    MeshShape shape;
    for (const uint32_t size : mesh.face_sizes) {
        if (size == 3)
            ++shape.triangles;
        else if (size == 4)
            ++shape.quads;
        else
            ++shape.others;
    }
    shape.joined = join_points(mesh);
    shape.near_edges = find_near_edges(mesh);
    count_edges(list_half_edges(mesh, number_points(mesh, shape.joined)), shape);
    return shape;
}

} // namespace relief
