#include <algorithm>
#include <cmath>
#include <compare>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "surface/map/displacement_change.h"
#include "surface/map/displacement_map.h"
#include "surface/mesh/base_frames.h"
#include "surface/mesh/base_heights.h"
#include "surface/mesh/polygons.h"
#include "surface/mesh/subdivide.h"
#include "surface/mesh/tile_links.h"
#include "surface/mesh/vertex_frames.h"
#include "surface/patch/surface.h"

namespace relief {

namespace {

/// Joins corners that agree in all they carry; numbers vertices in the order of their first use.
class VertexSplitter {
  public:
    struct Attributes {
        Vec2f uv{};
        Vec3f normal{}, bitangent{};
        std::array<float, 4> tangent{};
        TileIndex tile = 0;
        float handedness = 1;
        friend bool operator==(const Attributes&, const Attributes&) = default;
    };

    explicit VertexSplitter(size_t point_count) : first_of_point_(point_count, kNoIndex) {}

    uint32_t find_or_add(uint32_t point, const Attributes& attributes) {
        uint32_t* link = &first_of_point_[point];
        while (*link != kNoIndex) {
            if (vertices_[*link].attributes == attributes) return *link;
            link = &vertices_[*link].next;
        }
        const uint32_t vertex = uint32_t(vertices_.size());
        *link = vertex;
        vertices_.push_back({attributes, point, kNoIndex});
        return vertex;
    }

    /// Renumbers vertices: dominant ones first, each kind in order. Returns new numbers by old ones.
    std::vector<uint32_t> put_copies_last() {
        std::vector<uint32_t> numbers(vertices_.size());
        uint32_t next = 0;
        for (const bool is_dominant : {true, false})
            for (uint32_t v = 0; v < vertices_.size(); ++v)
                if ((dominant(v) == v) == is_dominant) numbers[v] = next++;
        const auto renumber = [&](uint32_t v) { return v == kNoIndex ? v : numbers[v]; };
        std::vector<Vertex> sorted(vertices_.size());
        for (uint32_t v = 0; v < vertices_.size(); ++v) {
            sorted[numbers[v]] = vertices_[v];
            sorted[numbers[v]].next = renumber(vertices_[v].next);
        }
        vertices_.swap(sorted);
        for (uint32_t& first : first_of_point_) first = renumber(first);
        return numbers;
    }

    uint32_t count() const { return uint32_t(vertices_.size()); }
    uint32_t point(uint32_t vertex) const { return vertices_[vertex].point; }
    uint32_t dominant(uint32_t vertex) const { return first_of_point_[vertices_[vertex].point]; }
    const Attributes& attributes(uint32_t vertex) const { return vertices_[vertex].attributes; }

  private:
    struct Vertex {
        Attributes attributes;
        uint32_t point, next;
    };
    std::vector<uint32_t> first_of_point_;
    std::vector<Vertex> vertices_;
};

/// Of the first `count` vertices.
void copy_positions(Surface& surface, const Polygons& polygons, const VertexSplitter& vertices,
                    uint32_t count) {
    surface.positions.resize(count);
    for (uint32_t v = 0; v < count; ++v) surface.positions[v] = polygons.positions[vertices.point(v)];
}

void copy_uvs(Surface& surface, const VertexSplitter& vertices) {
    surface.uvs.resize(vertices.count());
    for (uint32_t v = 0; v < vertices.count(); ++v) surface.uvs[v] = vertices.attributes(v).uv;
}

/// A patch for each face; `uvs`: one a corner.
PatchUvs make_patch_uvs(const Polygons& polygons, int number, const std::vector<Vec2f>& uvs) {
    PatchUvs result{number, std::vector<std::array<Vec2f, 4>>(polygons.face_count())};
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        for (uint32_t k = 0; k < 4; ++k)
            result.corners[face][k] = uvs[polygons.starts[face] + std::min(k, polygons.face_size(face) - 1)];
    return result;
}

/// Dominant vertices are those of the positions that are used, whose numbers store_patches() has changed.
void copy_base_heights(Surface& surface, const FramedBase& framed) {
    const std::vector<float> heights = find_base_heights(framed);
    if (heights.empty()) return;
    surface.base_heights.resize(surface.positions.size());
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (uint32_t k = 0; k < 4; ++k)
            surface.base_heights[surface.dominant(surface.quads[patch].vertex[k])] =
                heights[framed.base.polygons.points[4 * patch + k]];
}

void copy_further_uvs(Surface& surface, const Polygons& polygons) {
    for (const CornerUvs& set : polygons.further_uvs)
        surface.further_uvs.push_back(make_patch_uvs(polygons, set.number, set.uvs));
}

/// Fails where a texel coordinate would not fit the integers of the kernels.
void check_texel_range(const DisplacementMap& map, const Polygons& polygons, uint32_t face, const Vec2f& uv) {
    double size = 1;
    for (const DisplacementMap::Tile& tile : map.tiles)
        size = std::max({size, double(tile.texture->width), double(tile.texture->height)});
    if (size * (1 + std::max(std::fabs(uv.x), std::fabs(uv.y))) < 0x1p30) return;
    throw Error(ErrorKind::bad_input,
                {fmt::format("uv ({}, {}) is too far out for a map of {} texels", uv.x, uv.y, size),
                 fmt::format("{}, face {}", polygons.where, polygons.source_faces[face]),
                 "unwrap the mesh again"});
}

/// For each face, whether its face of the mesh has no uvs; empty where all have.
std::vector<uint8_t> mark_faces_without_uvs(const Mesh& mesh, const Polygons& polygons) {
    std::vector<uint8_t> of_mesh, result;
    size_t corner = 0;
    bool is_any = false;
    for (const uint32_t size : mesh.face_sizes) {
        of_mesh.push_back(mesh.uv_indices[corner] == kNoIndex);
        is_any = is_any || of_mesh.back() != 0;
        corner += size;
    }
    if (!is_any) return result;
    for (const uint32_t source : polygons.source_faces) result.push_back(of_mesh[source]);
    return result;
}

/// What corners bring to their vertices beside uvs.
void add_frame_attributes(const Polygons& polygons, uint32_t corner, VertexSplitter::Attributes& attributes) {
    if (!polygons.normals.empty()) attributes.normal = polygons.normals[corner];
    if (!polygons.bitangents.empty()) attributes.bitangent = polygons.bitangents[corner];
    if (polygons.tangents.empty()) return;
    attributes.tangent = polygons.tangents[corner];
    attributes.handedness = attributes.tangent[3] < 0 ? -1.0f : 1.0f;
}

VertexSources list_sources(const Polygons& polygons, const VertexSplitter& vertices) {
    VertexSources sources;
    for (uint32_t v = 0; v < vertices.count(); ++v) {
        const VertexSplitter::Attributes& attributes = vertices.attributes(v);
        sources.points.push_back(vertices.point(v));
        sources.handedness.push_back(attributes.handedness);
        if (!polygons.normals.empty()) sources.normals.push_back(attributes.normal);
        if (!polygons.tangents.empty()) sources.tangents.push_back(attributes.tangent);
        if (!polygons.bitangents.empty()) sources.bitangents.push_back(attributes.bitangent);
    }
    return sources;
}

/// Patches and what their vertices share: the dominant ones get the lowest numbers.
void store_patches(std::vector<Quad>& quads, VertexSplitter& vertices, Surface& surface) {
    const std::vector<uint32_t> numbers = vertices.put_copies_last();
    surface.quads.reset(quads.size(), vertices.count());
    for (size_t k = 0; k < quads.size(); ++k) {
        for (uint32_t& vertex : quads[k].vertex) vertex = numbers[vertex];
        surface.quads.set(k, quads[k]);
    }
    for (uint32_t v = 0; v < vertices.count(); ++v)
        if (vertices.dominant(v) != v) surface.copies.push_back({vertices.dominant(v)});
    surface.copies.shrink_to_fit();
}

/// Finds or adds the vertices of a face, whose map is cut into tiles where `is_udim`.
Quad split_face(Surface& surface, const Polygons& polygons, uint32_t face, bool is_udim, bool has_uvs,
                VertexSplitter& vertices) {
    const uint32_t start = polygons.starts[face];
    std::array<Vec2f, 4> uvs;
    for (uint32_t k = 0; k < 4; ++k) {
        uvs[k] = {polygons.uvs[start + k].x + 0.0f, polygons.uvs[start + k].y + 0.0f};
        check_texel_range(surface.map, polygons, face, uvs[k]);
    }
    TileChoice tile;
    if (!has_uvs)
        tile.index = Surface::kNoTile;
    else if (is_udim)
        tile = choose_tile(surface.map, uvs);
    VertexSplitter::Attributes attributes;
    attributes.tile = tile.index;
    attributes.handedness = compute_uv_area(uvs) < 0 ? -1.0f : 1.0f;
    Quad quad;
    for (uint32_t k = 0; k < 4; ++k) {
        attributes.uv = {uvs[k].x - tile.offset.x, uvs[k].y - tile.offset.y};
        add_frame_attributes(polygons, start + k, attributes);
        quad.vertex[k] = vertices.find_or_add(polygons.points[start + k], attributes);
    }
    return quad;
}

/// Patches and split vertices. Vertices of faces in `lacks_uvs` come first: dominant, not displaced.
VertexSources split_displaced(Surface& surface, const Polygons& polygons, bool is_udim,
                              const std::vector<uint8_t>& lacks_uvs) {
    VertexSplitter vertices(polygons.positions.size());
    std::vector<Quad> quads(polygons.face_count());
    for (const bool is_marked : {true, false})
        for (uint32_t face = 0; face < polygons.face_count(); ++face)
            if ((!lacks_uvs.empty() && lacks_uvs[face] != 0) == is_marked)
                quads[face] = split_face(surface, polygons, face, is_udim, !is_marked, vertices);
    store_patches(quads, vertices, surface);
    if (is_udim || !lacks_uvs.empty())
        for (uint32_t v = 0; v < vertices.count(); ++v)
            surface.vertex_tiles.push_back(vertices.attributes(v).tile);
    copy_positions(surface, polygons, vertices, vertices.count() - uint32_t(surface.copies.size()));
    copy_uvs(surface, vertices);
    return list_sources(polygons, vertices);
}

/// Where patch edges between the same two points have different vertices, all take those of the lowest patch
/// that is marked in `lacks_uvs`, or else of the lowest: a face without uvs is not displaced at its edges.
void find_overrides(Surface& surface, const std::vector<uint8_t>& lacks_uvs) {
    if (surface.copies.empty()) return;
    struct Edge {
        uint64_t key;
        uint32_t patch_edge;
        auto operator<=>(const Edge&) const = default;
    };
    std::vector<Edge> edges;
    std::vector<EdgeOverride> overrides;
    std::vector<bool> has_copies(surface.positions.size());
    for (size_t copy = 0; copy < surface.copies.size(); ++copy) has_copies[surface.copies[copy][0]] = true;
    const auto get_ends = [&](uint32_t patch_edge) {
        const Quad quad = surface.quads[patch_edge / 4];
        return std::array<uint32_t, 2>{quad.vertex[patch_edge & 3], quad.vertex[(patch_edge + 1) & 3]};
    };
    for (uint32_t patch_edge = 0; patch_edge < 4 * surface.patch_count(); ++patch_edge) {
        const auto ends = get_ends(patch_edge);
        const uint64_t a = surface.dominant(ends[0]), b = surface.dominant(ends[1]);
        if (!has_copies[a] && !has_copies[b]) continue; // all patches have the same two vertices
        edges.push_back({std::min(a, b) << 32 | std::max(a, b), patch_edge});
    }
    std::sort(edges.begin(), edges.end());
    if (!lacks_uvs.empty())
        std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
            return a.key != b.key ? a.key < b.key : lacks_uvs[a.patch_edge / 4] > lacks_uvs[b.patch_edge / 4];
        });
    for (size_t first = 0, end = 0; first < edges.size(); first = end) {
        bool is_seam = false;
        const size_t begin = overrides.size();
        for (end = first; end < edges.size() && edges[end].key == edges[first].key; ++end) {
            std::array<uint32_t, 2> leading = get_ends(edges[first].patch_edge);
            const auto own = get_ends(edges[end].patch_edge);
            if (surface.dominant(leading[0]) != surface.dominant(own[0])) std::swap(leading[0], leading[1]);
            is_seam = is_seam || leading != own;
            overrides.push_back({edges[end].patch_edge, leading[0], leading[1]});
        }
        if (!is_seam) overrides.resize(begin);
    }
    std::sort(overrides.begin(), overrides.end(),
              [](const EdgeOverride& a, const EdgeOverride& b) { return a.patch_edge < b.patch_edge; });
    surface.overrides = EdgeOverrides(overrides, surface.quads.size());
}

/// Fails where an axis of a relative frame carries the map's largest displacement too far.
void check_derivatives(Surface& surface, const std::string& name) {
    if (surface.derivatives.empty()) return;
    float& longest = surface.map.longest_axis;
    for (const std::array<Vec3f, 2>& derivatives : surface.derivatives)
        for (const Vec3f& derivative : derivatives)
            for (const float value : {derivative.x, derivative.y, derivative.z})
                longest = std::fmax(longest, std::fabs(value));
    check_reach(name, surface.map);
}

/// Cells per side that a patch of a whole face needs to be as smooth as those of level 3.
constexpr int kCellsOfFace = 256;

BaseTolerance choose_tolerance(const SurfaceContext& context, const Polygons& polygons) {
    if (context.tolerance) return *context.tolerance;
    Box box;
    for (const Vec3f& p : polygons.positions) box.extend(p);
    return {find_tolerance_exponent(double(length(box.extent())) / 8192), {}};
}

/// Returns the limit surface of the context, or null if that lacks uv sets that are wanted.
const SubdivisionMesh* get_limit(const SurfaceContext& context) {
    return context.uv_sets.empty() ? context.limit : nullptr;
}

Surface make_displaced(const Mesh& mesh, const Displacement& displacement, const SurfaceContext& context,
                       PyramidCache& pyramids) {
    const std::span<const int> uv_sets = context.uv_sets;
    Polygons polygons = make_polygons(mesh, Welding::joined_points, uv_sets);
    if (polygons.uvs.empty())
        throw Error(ErrorKind::bad_input,
                    {fmt::format("mesh has no uvs, but displacement '{}' needs them", displacement.name),
                     polygons.where, "unwrap the mesh"});
    Surface surface;
    surface.name = mesh.name;
    surface.has_displacement = true;
    surface.map = make_displacement_map(displacement, context.object_from_world, pyramids,
                                        displacement.is_udim
                                            ? find_tile_links(mesh, displacement.tiles, displacement.flip_v)
                                            : std::vector<TileNeighbours>());
    const DisplacementChange change(surface.map, displacement.is_udim);
    const BaseNeeds needs{BasePatches::bicubic, choose_tolerance(context, polygons), &change,
                          displacement.type == DisplacementType::vector &&
                              displacement.lengths == FrameLengths::relative,
                          get_limit(context)};
    FramedBase framed = make_framed_base(std::move(polygons), mesh, displacement, needs);
    const std::vector<uint8_t> lacks_uvs = mark_faces_without_uvs(mesh, framed.base.polygons);
    VertexSources sources = split_displaced(surface, framed.base.polygons, displacement.is_udim, lacks_uvs);
    find_overrides(surface, lacks_uvs);
    copy_further_uvs(surface, framed.base.polygons);
    if (displacement.is_udim && std::ranges::find(uv_sets, kOwnUvSet) != uv_sets.end())
        surface.further_uvs.push_back(
            make_patch_uvs(framed.base.polygons, kOwnUvSet, framed.base.polygons.uvs));
    copy_base_heights(surface, framed);
    surface.controls = std::move(framed.base.controls);
    surface.base_reserve = framed.base.reserve;
    if (mesh.subdivision.level == kAutoSubdivisionLevel) surface.most_base_cells = kCellsOfFace;
    sources.point_normals = std::move(framed.point_normals);
    // A height moves along the normal alone.
    if (displacement.type == DisplacementType::vector) sources.lengths = displacement.lengths;
    compute_vertex_frames(surface, sources);
    check_derivatives(surface, displacement.name);
    return surface;
}

Polygons make_plain_polygons(const Mesh& mesh, const SurfaceContext& context, BaseReserve& reserve) {
    const std::span<const int> uv_sets = context.uv_sets;
    if (mesh.subdivision.scheme == SubdivisionScheme::none)
        return cut_to_triangles(make_polygons(mesh, Welding::none, uv_sets));
    Polygons polygons = make_polygons(mesh, Welding::joined_points, uv_sets);
    if (mesh.subdivision.scheme == SubdivisionScheme::bilinear)
        polygons = cut_concave_faces(std::move(polygons));
    const BaseNeeds needs{BasePatches::bilinear, choose_tolerance(context, polygons), nullptr, false,
                          get_limit(context)};
    const SmoothBase base = subdivide(polygons, mesh.subdivision, needs);
    reserve = base.reserve;
    return cut_to_triangles(base.polygons);
}

Surface make_plain(const Mesh& mesh, const SurfaceContext& context) {
    Surface surface;
    const Polygons polygons = make_plain_polygons(mesh, context, surface.base_reserve);
    surface.name = mesh.name;
    VertexSplitter vertices(polygons.positions.size());
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face];
        Quad quad;
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t corner = start + std::min(k, polygons.face_size(face) - 1);
            VertexSplitter::Attributes attributes;
            if (!polygons.uvs.empty()) attributes.uv = polygons.uvs[corner];
            if (!polygons.normals.empty()) attributes.normal = polygons.normals[corner];
            quad.vertex[k] = vertices.find_or_add(polygons.points[corner], attributes);
        }
        surface.quads.push_back(quad);
    }
    copy_positions(surface, polygons, vertices, vertices.count());
    surface.quads.shrink_to_fit();
    copy_further_uvs(surface, polygons);
    if (!polygons.uvs.empty()) copy_uvs(surface, vertices);
    if (!polygons.normals.empty())
        for (uint32_t v = 0; v < vertices.count(); ++v)
            surface.frames.push_back({pack_frame(normalize(vertices.attributes(v).normal), {}, 1).normal, 0});
    return surface;
}

} // namespace

Surface make_surface(const Mesh& mesh, const Displacement* displacement, const SurfaceContext& context) {
    if (!displacement) return make_plain(mesh, context);
    PyramidCache own_pyramids;
    return make_displaced(mesh, *displacement, context, context.pyramids ? *context.pyramids : own_pyramids);
}

} // namespace relief
