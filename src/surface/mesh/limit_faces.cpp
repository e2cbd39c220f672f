// Limit faces of subdivision meshes. A face whose corners are regular is a bicubic B-spline patch of the
// sixteen points around it; beyond edges that are sharp the points are those that make the boundary a spline
// of its own (OpenSubdiv's boundary patches). Other faces between smooth points are made of cells that are
// such patches. OpenSubdiv evaluates what is left: faces at creases and at irregular boundaries.
#include <fmt/format.h>

#include "base/parallel.h"
#include "relief/error.h"
#include "surface/mesh/subdivision_topology.h"

namespace relief {

namespace {

using GridPlace = std::array<size_t, 2>; ///< column and row of SplineControls

/// The corners of a face have the places kCorners. The points behind edge k, next to its begin and to its
/// end, have kBehindEdge, and the point diagonally behind corner k has kBehindCorner.
constexpr std::array<GridPlace, 4> kCorners = {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
constexpr std::array<std::array<GridPlace, 2>, 4> kBehindEdge = {
    {{{{1, 0}, {2, 0}}}, {{{3, 1}, {3, 2}}}, {{{2, 3}, {1, 3}}}, {{{0, 2}, {0, 1}}}}};
constexpr std::array<GridPlace, 4> kBehindCorner = {{{0, 0}, {3, 0}, {3, 3}, {0, 3}}};
/// From a place behind edge k two and one steps back across the edge.
constexpr std::array<std::array<int, 2>, 4> kInward = {{{0, 1}, {-1, 0}, {0, -1}, {1, 0}}};

bool is_sharp_edge(const osd::Far::TopologyLevel& level, int edge) {
    return level.GetEdgeSharpness(edge) > 0;
}

/// Place of a value in a list of few.
template <class List, class Value> int find_in(const List& list, Value value) {
    int k = 0;
    while (list[k] != value) ++k;
    return k;
}

void prepare_points(const std::vector<double>& mesh_points, LimitFace::Surface& limit) {
    limit.points.resize(3 * size_t(limit.surface.GetNumPatchPoints()));
    limit.surface.PreparePatchPoints(mesh_points.data(), 3, limit.points.data(), 3);
    limit.parameters = limit.surface.GetParameterization();
}

/// The fan around corner k of a face after a step of subdivision (Catmull and Clark 1978). Returns false if
/// the faces around the point do not lead back to the first one.
template <class Read>
bool fill_fan(const osd::Far::TopologyLevel& base, int face, int k, const Read& read_corner, PointFan& fan) {
    const auto count = size_t(base.GetVertexFaces(base.GetFaceVertices(face)[k]).size());
    const Vec3d point = read_corner(face, k);
    std::array<Vec3d, PointFan::kMostEdges> ends;
    int at = face, corner = k;
    for (size_t n = 0; n < count; ++n) {
        const int size = base.GetFaceVertices(at).size();
        Vec3d sum{};
        for (int c = 0; c < size; ++c) sum = sum + read_corner(at, c);
        fan.faces[n] = sum * (1.0 / size);
        ends[n] = read_corner(at, (corner + 1) % size);
        const osd::Far::Index edge = base.GetFaceEdges(at)[(corner + size - 1) % size];
        const osd::Far::ConstIndexArray faces = base.GetEdgeFaces(edge);
        if (faces.size() != 2) return false;
        const int across = faces[0] == at ? 1 : 0;
        at = faces[across], corner = base.GetEdgeFaceLocalIndices(edge)[across];
    }
    if (at != face || corner != k) return false;
    Vec3d middles{}, means{};
    for (size_t n = 0; n < count; ++n) {
        fan.edges[n] = (point + ends[n] + fan.faces[n] + fan.faces[(n + count - 1) % count]) * 0.25;
        middles = middles + (point + ends[n]) * 0.5, means = means + fan.faces[n];
    }
    const auto size = double(count);
    fan.count = count;
    fan.point = (means * (1 / size) + middles * (2 / size) + point * (size - 3)) * (1 / size);
    return true;
}

} // namespace

/// Corners of a quad, or of all parts of a polygon, that are irregular, as bits; and whether everything apart
/// from them is bicubic: no crease that wears off touches the face.
std::pair<uint32_t, bool> SubdivisionMesh::Implementation::find_irregular_corners(uint32_t face) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const osd::Far::ConstIndexArray points = base.GetFaceVertices(int(face));
    const bool is_quad = points.size() == 4;
    uint32_t irregular = 0;
    bool is_bicubic_apart = true;
    for (int k = 0; k < points.size(); ++k) {
        const bool is_regular = is_regular_point(base, points[k]) && has_quads_only(base, points[k]);
        if (!is_regular) irregular |= is_quad ? 1u << k : 1u;
        is_bicubic_apart = is_bicubic_apart && !is_semi_sharp(base.GetVertexSharpness(points[k]));
        for (const int edge : base.GetVertexEdges(points[k]))
            is_bicubic_apart = is_bicubic_apart && !is_semi_sharp(base.GetEdgeSharpness(edge));
    }
    if (!is_quad) irregular |= 4u; // the middle of the polygon
    return {irregular, is_bicubic_apart};
}

/// Whether the uvs of a face are apart from those of its neighbour along a side.
bool SubdivisionMesh::Implementation::is_seam(uint32_t face, int side, int channel) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const osd::Far::Index edge = base.GetFaceEdges(int(face))[side];
    const osd::Far::ConstIndexArray faces = base.GetEdgeFaces(edge);
    if (faces.size() != 2) return true;
    const int across = faces[0] == int(face) ? 1 : 0;
    const int other = base.GetEdgeFaceLocalIndices(edge)[across];
    const osd::Far::ConstIndexArray own = base.GetFaceFVarValues(int(face), channel),
                                    their = base.GetFaceFVarValues(faces[across], channel);
    return own[side] != their[(other + 1) & 3] || own[(side + 1) & 3] != their[other];
}

/// Whether the uvs around a corner of a bicubic face make splines: they are joined as the positions are, or
/// a seam runs straight past the face, or turns at it.
bool SubdivisionMesh::Implementation::has_spline_uvs_at(uint32_t face, int corner, int channel) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const int point = base.GetFaceVertices(int(face))[corner];
    if (base.DoesVertexFVarTopologyMatch(point, channel)) return true;
    if (base.IsVertexBoundary(point)) return false;
    for (const int edge : base.GetVertexEdges(point))
        if (is_sharp_edge(base, edge)) return false;
    const osd::Far::ConstIndexArray faces = base.GetVertexFaces(point);
    const osd::Far::ConstLocalIndexArray places = base.GetVertexFaceLocalIndices(point);
    const int own = base.GetFaceFVarValues(int(face), channel)[corner];
    int same = 0, seams = 0;
    for (int k = 0; k < faces.size(); ++k) {
        same += base.GetFaceFVarValues(faces[k], channel)[places[k]] == own;
        seams += is_seam(uint32_t(faces[k]), places[k], channel);
    }
    const int own_seams = is_seam(face, corner, channel) + is_seam(face, (corner + 3) & 3, channel);
    // More than two islands meet in corners (FVAR_LINEAR_CORNERS_PLUS1).
    return (same == 1 && own_seams == 2) || (same == 2 && own_seams == 1 && seams == 2);
}

uint8_t SubdivisionMesh::Implementation::find_spline_uvs_of(uint32_t face, int channel) const {
    if (!is_bicubic[face]) return 0;
    uint8_t result = kSplineUvs;
    for (int k = 0; k < 4; ++k) {
        if (!has_spline_uvs_at(face, k, channel)) return 0;
        const osd::Far::TopologyLevel base = refiner->GetLevel(0);
        if (is_sharp_edge(base, base.GetFaceEdges(int(face))[k]) || is_seam(face, k, channel))
            result |= uint8_t(1 << k);
    }
    return result;
}

void SubdivisionMesh::Implementation::find_spline_uvs() {
    for (size_t channel = 0; channel < uv_sets.size(); ++channel) {
        std::vector<uint8_t>& known = spline_uvs.emplace_back(is_bicubic.size());
        parallel_for("splines of uvs", known.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t face = begin; face < end; ++face)
                known[face] = find_spline_uvs_of(uint32_t(face), int(channel));
        });
    }
}

/// Control points of a bicubic face; read_corner(face, k) is the value at corner k of a face, and values are
/// apart from those across side k where is_sharp_side(k).
template <class Read, class Sharp>
SplineControls SubdivisionMesh::Implementation::find_controls(uint32_t face, const Read& read_corner,
                                                              const Sharp& is_sharp_side) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const osd::Far::ConstIndexArray points = base.GetFaceVertices(int(face)),
                                    edges = base.GetFaceEdges(int(face));
    SplineControls controls;
    const auto at = [&](const GridPlace& place) -> Vec3d& { return controls[place[0]][place[1]]; };
    const auto extrapolate = [&](const GridPlace& place, size_t edge) {
        const auto [x, y] = kInward[edge];
        const GridPlace near{size_t(int(place[0]) + x), size_t(int(place[1]) + y)},
            far{size_t(int(place[0]) + 2 * x), size_t(int(place[1]) + 2 * y)};
        at(place) = at(near) * 2.0 - at(far);
    };
    std::array<bool, 4> is_sharp;
    for (size_t k = 0; k < 4; ++k) {
        at(kCorners[k]) = read_corner(int(face), int(k));
        is_sharp[k] = is_sharp_side(int(k));
    }
    for (size_t k = 0; k < 4; ++k) {
        if (is_sharp[k]) continue;
        const osd::Far::ConstIndexArray faces = base.GetEdgeFaces(edges[int(k)]);
        const int side = faces[0] == int(face) ? 1 : 0;
        const int own = base.GetEdgeFaceLocalIndices(edges[int(k)])[side];
        at(kBehindEdge[k][0]) = read_corner(faces[side], (own + 2) & 3);
        at(kBehindEdge[k][1]) = read_corner(faces[side], (own + 3) & 3);
    }
    for (size_t k = 0; k < 4; ++k)
        if (is_sharp[k]) extrapolate(kBehindEdge[k][0], k), extrapolate(kBehindEdge[k][1], k);
    for (size_t k = 0; k < 4; ++k) {
        const size_t before = (k + 3) % 4;
        if (is_sharp[k] || is_sharp[before]) {
            extrapolate(kBehindCorner[k], is_sharp[k] ? k : before);
            continue;
        }
        const osd::Far::ConstIndexArray faces = base.GetVertexFaces(points[int(k)]);
        const int opposite = (find_in(faces, int(face)) + 2) & 3;
        const int own = base.GetVertexFaceLocalIndices(points[int(k)])[opposite];
        at(kBehindCorner[k]) = read_corner(faces[opposite], (own + 2) & 3);
    }
    return controls;
}

/// Cells of a quad, or of the parts of a polygon, whose corners are smooth; empty for other faces.
template <class Read>
std::vector<LimitCells> SubdivisionMesh::Implementation::find_cells(uint32_t face,
                                                                    const Read& read_corner) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const osd::Far::ConstIndexArray points = base.GetFaceVertices(int(face));
    const auto is_few = [](int count) { return count >= 3 && count <= int(PointFan::kMostEdges); };
    if (is_bicubic.empty() || !is_few(points.size())) return {};
    std::vector<PointFan> fans(size_t(points.size()));
    for (int k = 0; k < points.size(); ++k)
        if (!is_smooth_point(base, points[k]) || !is_few(base.GetVertexFaces(points[k]).size()) ||
            !fill_fan(base, int(face), k, read_corner, fans[size_t(k)]))
            return {};
    std::vector<LimitCells> cells;
    if (fans.size() == 4) {
        cells.emplace_back(std::array<PointFan, 4>{fans[0], fans[1], fans[2], fans[3]});
        return cells;
    }
    for (size_t part = 0; part < fans.size(); ++part) cells.emplace_back(find_fans_of_part(fans, part));
    return cells;
}

LimitFace SubdivisionMesh::Implementation::make_uv_face(uint32_t face, int channel) const {
    const std::vector<double>& points = uv_points[size_t(channel)];
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const auto read_uv = [&](int other, int k) {
        return read(&points[3 * size_t(base.GetFaceFVarValues(other, channel)[k])]);
    };
    if (is_bicubic_in_set(face, channel)) {
        const uint8_t sharp = spline_uvs[size_t(channel)][face];
        return LimitFace(find_controls(face, read_uv, [&](int k) { return (sharp >> k & 1) != 0; }));
    }
    std::shared_ptr<const LimitFace::Surface>* kept =
        kept_uv_faces.empty() ? nullptr : &kept_uv_faces[size_t(channel)][face];
    if (kept && *kept) return LimitFace(*kept, 0, false);
    auto limit = std::make_shared<LimitFace::Surface>();
    bool is_joined = true;
    for (const int point : base.GetFaceVertices(int(face)))
        is_joined = is_joined && base.DoesVertexFVarTopologyMatch(point, channel);
    if (is_joined && has_smooth_uvs) limit->cells = find_cells(face, read_uv);
    if (limit->cells.empty()) {
        if (!uv_factory->InitFaceVaryingSurface(int(face), &limit->surface,
                                                osd::Bfr::SurfaceFactory::Index(channel)))
            throw Error(ErrorKind::bad_input,
                        {"the uvs of a face have no limit", fmt::format("{}, face {}", where, face),
                         "repair the mesh, or set the subdivision's uv rule to linear"});
        prepare_points(points, *limit);
    }
    if (kept) *kept = limit;
    return LimitFace(std::move(limit), 0, false);
}

LimitFace SubdivisionMesh::Implementation::make_face(uint32_t face) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const auto read_point = [&](int other, int k) {
        return read(&positions[3 * size_t(base.GetFaceVertices(other)[k])]);
    };
    if (!is_bicubic.empty() && is_bicubic[face])
        return LimitFace(find_controls(
            face, read_point, [&](int k) { return is_sharp_edge(base, base.GetFaceEdges(int(face))[k]); }));
    const auto [irregular, is_bicubic_apart] = find_irregular_corners(face);
    std::shared_ptr<const LimitFace::Surface> limit;
    if (!kept_faces.empty()) limit = kept_faces[face];
    if (!limit) {
        auto made = std::make_shared<LimitFace::Surface>();
        made->cells = find_cells(face, read_point);
        if (made->cells.empty()) {
            if (!factory->InitVertexSurface(int(face), &made->surface))
                throw Error(ErrorKind::bad_input,
                            {"a face has no limit surface", fmt::format("{}, face {}", where, face),
                             "repair the mesh, or set the subdivision scheme to none"});
            prepare_points(positions, *made);
        }
        limit = std::move(made);
        if (!kept_faces.empty()) kept_faces[face] = limit;
    }
    return LimitFace(limit, irregular, is_bicubic_apart);
}

LimitFace SubdivisionMesh::make_face(uint32_t face) const { return implementation_->make_face(face); }

LimitFace SubdivisionMesh::make_uv_face(uint32_t face, uint32_t set) const {
    return implementation_->make_uv_face(face, int(set));
}

bool SubdivisionMesh::has_smooth_uvs() const { return implementation_->has_smooth_uvs; }

} // namespace relief
