// Cages and limit faces of subdivision meshes. A face whose corners are regular is a bicubic B-spline patch
// of the sixteen points around it, found without OpenSubdiv's tables; beyond edges that are sharp the points
// are those that make the boundary a spline of its own (OpenSubdiv's boundary patches).
#include "surface/mesh/cage.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "relief/error.h"
#include "surface/mesh/subdivision_topology.h"

namespace relief {

namespace {

using GridPlace = std::array<size_t, 2>; ///< column and row of SplineControls

/// Where the corners of a face are, what lies behind edge k next to its begin and to its end, and what lies
/// diagonally behind corner k.
constexpr std::array<GridPlace, 4> kCorners = {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
constexpr std::array<std::array<GridPlace, 2>, 4> kBehindEdge = {
    {{{{1, 0}, {2, 0}}}, {{{3, 1}, {3, 2}}}, {{{2, 3}, {1, 3}}}, {{{0, 2}, {0, 1}}}}};
constexpr std::array<GridPlace, 4> kBehindCorner = {{{0, 0}, {3, 0}, {3, 3}, {0, 3}}};
/// From a place behind edge k two and one steps back across the edge.
constexpr std::array<std::array<int, 2>, 4> kInward = {{{0, 1}, {-1, 0}, {0, -1}, {1, 0}}};

bool is_sharp_edge(const osd::Far::TopologyLevel& level, int edge) {
    return level.GetEdgeSharpness(edge) > 0;
}

bool has_quads_only(const osd::Far::TopologyLevel& level, int point) {
    for (const int face : level.GetVertexFaces(point))
        if (level.GetFaceVertices(face).size() != 4) return false;
    return true;
}

/// Place of a value in a list of few.
template <class List, class Value> int find_in(const List& list, Value value) {
    int k = 0;
    while (list[k] != value) ++k;
    return k;
}

} // namespace

bool is_regular_point(const osd::Far::TopologyLevel& level, int point) {
    if (level.IsVertexNonManifold(point)) return false;
    const float sharpness = level.GetVertexSharpness(point);
    if (is_semi_sharp(sharpness)) return false;
    const osd::Far::ConstIndexArray edges = level.GetVertexEdges(point);
    int sharp_count = 0, first_sharp = 0, last_sharp = 0;
    for (int k = 0; k < edges.size(); ++k) {
        const float edge_sharpness = level.GetEdgeSharpness(edges[k]);
        if (is_semi_sharp(edge_sharpness)) return false;
        if (edge_sharpness <= 0) continue;
        if (sharp_count++ == 0) first_sharp = k;
        last_sharp = k;
    }
    if (level.IsVertexBoundary(point))
        return sharp_count == 2 && (sharpness > 0 ? edges.size() == 2 : edges.size() == 3);
    return edges.size() == 4 && sharpness == 0 &&
           (sharp_count == 0 || (sharp_count == 2 && last_sharp - first_sharp == 2));
}

bool is_straight_point(const osd::Far::TopologyLevel& level, int point) {
    if (level.IsVertexNonManifold(point) || level.IsVertexBoundary(point)) return false;
    const osd::Far::ConstIndexArray edges = level.GetVertexEdges(point);
    if (level.GetVertexSharpness(point) > 0 || edges.size() != 4) return false;
    for (int k = 0; k < 2; ++k) {
        const float along = level.GetEdgeSharpness(edges[k]);
        if (is_semi_sharp(along) && along == level.GetEdgeSharpness(edges[k + 2]))
            return level.GetEdgeSharpness(edges[1 - k]) == 0 && level.GetEdgeSharpness(edges[3 - k]) == 0;
    }
    return false;
}

void SubdivisionMesh::Implementation::find_bicubic_faces() {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    std::vector<bool> is_bicubic_around(size_t(base.GetNumVertices()));
    for (int point = 0; point < base.GetNumVertices(); ++point)
        is_bicubic_around[size_t(point)] = is_regular_point(base, point) && has_quads_only(base, point);
    is_bicubic.resize(size_t(base.GetNumFaces()));
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        bool is_regular = base.GetFaceVertices(face).size() == 4;
        for (const int point : base.GetFaceVertices(face))
            is_regular = is_regular && is_bicubic_around[size_t(point)];
        is_bicubic[size_t(face)] = is_regular;
    }
}

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

/// Whether the uvs around a bicubic face are joined as its positions are.
bool SubdivisionMesh::Implementation::is_bicubic_in_set(uint32_t face, int channel) const {
    if (!is_bicubic[face]) return false;
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    for (const int point : base.GetFaceVertices(int(face)))
        if (!base.DoesVertexFVarTopologyMatch(point, channel)) return false;
    return true;
}

/// Control points of a bicubic face; read_corner(face, k) is the value at corner k of a face.
template <class Read>
SplineControls SubdivisionMesh::Implementation::find_controls(uint32_t face, const Read& read_corner) const {
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
        is_sharp[k] = is_sharp_edge(base, edges[int(k)]);
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

LimitFace SubdivisionMesh::Implementation::make_uv_face(uint32_t face, int channel) const {
    const std::vector<double>& points = uv_points[size_t(channel)];
    if (!is_bicubic.empty() && is_bicubic_in_set(face, channel)) {
        const osd::Far::TopologyLevel base = refiner->GetLevel(0);
        return LimitFace(find_controls(face, [&](int other, int k) {
            return read(&points[3 * size_t(base.GetFaceFVarValues(other, channel)[k])]);
        }));
    }
    std::shared_ptr<const LimitFace::Surface>* kept =
        kept_uv_faces.empty() ? nullptr : &kept_uv_faces[size_t(channel)][face];
    if (kept && *kept) return LimitFace(*kept, 0, false);
    auto limit = std::make_shared<LimitFace::Surface>();
    if (!factory->InitFaceVaryingSurface(int(face), &limit->surface,
                                         osd::Bfr::SurfaceFactory::Index(channel)))
        throw Error(ErrorKind::bad_input,
                    {"the uvs of a face have no limit", fmt::format("{}, face {}", where, face),
                     "repair the mesh, or set the subdivision's uv rule to linear"});
    limit->points.resize(3 * size_t(limit->surface.GetNumPatchPoints()));
    limit->surface.PreparePatchPoints(points.data(), 3, limit->points.data(), 3);
    limit->parameters = limit->surface.GetParameterization();
    if (kept) *kept = limit;
    return LimitFace(std::move(limit), 0, false);
}

/// Limits of the uv values of the mesh as it is, each by one of the faces that have it. OpenSubdiv 3.5's own
/// (PrimvarRefiner::LimitFaceVarying) are wrong beside seams before the first step.
std::vector<Vec2f> SubdivisionMesh::Implementation::find_base_uv_values(int channel) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    const size_t count = uv_sets[size_t(channel)].values.size();
    if (!has_smooth_uvs) return uv_sets[size_t(channel)].values;
    // The face and corner that each value is evaluated at: of a bicubic face if there is one.
    struct Place {
        uint32_t face = kNoIndex, corner = 0;
    };
    std::vector<Place> places(count);
    std::vector<std::vector<uint32_t>> values_of_face(size_t(base.GetNumFaces()));
    for (const bool is_bicubic_turn : {true, false})
        for (int face = 0; face < base.GetNumFaces(); ++face) {
            const osd::Far::ConstIndexArray own = base.GetFaceFVarValues(face, channel);
            bool is_wanted = false;
            for (const int value : own) is_wanted = is_wanted || places[size_t(value)].face == kNoIndex;
            if (!is_wanted || is_bicubic_in_set(uint32_t(face), channel) != is_bicubic_turn) continue;
            for (int k = 0; k < own.size(); ++k) {
                Place& place = places[size_t(own[k])];
                if (place.face != kNoIndex) continue;
                place = {uint32_t(face), uint32_t(k)};
                values_of_face[size_t(face)].push_back(uint32_t(own[k]));
            }
        }
    std::vector<Vec2f> values(count);
    parallel_for("limit uvs", values_of_face.size(), 64, [&](size_t begin, size_t end) {
        for (uint32_t face = uint32_t(begin); face < end; ++face) {
            if (values_of_face[face].empty()) continue;
            const LimitFace limit = make_uv_face(face, channel);
            const bool is_quad = base.GetFaceVertices(int(face)).size() == 4;
            for (const uint32_t value : values_of_face[face]) {
                const uint32_t k = places[value].corner;
                const auto [u, v] = is_quad ? kCorner[k] : std::array<uint32_t, 2>{0, 0};
                const Vec3d uv = limit.evaluate_position(is_quad ? 0 : k, u, v);
                values[value] = {float(uv.x), float(uv.y)};
            }
        }
    });
    return values;
}

Cage SubdivisionMesh::Implementation::make_cage() const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    Cage cage;
    cage.point_count = uint32_t(base.GetNumVertices());
    cage.starts.push_back(0);
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        for (const int point : base.GetFaceVertices(face)) cage.points.push_back(uint32_t(point));
        for (const int edge : base.GetFaceEdges(face)) cage.edges.push_back(uint32_t(edge));
        cage.starts.push_back(uint32_t(cage.points.size()));
        cage.places.push_back({uint32_t(face), 0, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}});
    }
    cage.is_accurate.resize(cage.places.size());
    cage.fits.assign(cage.places.size(), kNoIndex);
    cage.has_uvs = has_uvs;
    for (size_t set = 0; set < uv_sets.size(); ++set) cage.uvs.push_back(find_limit_uvs(int(set)));
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        const float sharpness = base.GetEdgeSharpness(edge);
        cage.is_sharp.push_back(sharpness >= kInfiniteSharpness);
        cage.semi_sharpness.push_back(is_semi_sharp(sharpness) ? sharpness : 0.0f);
    }
    for (int point = 0; point < base.GetNumVertices(); ++point) {
        const bool has_quads = has_quads_only(base, point);
        cage.is_regular.push_back(is_regular_point(base, point) && has_quads);
        cage.is_straight.push_back(is_straight_point(base, point) && has_quads);
    }
    cage.limit_normals = find_limit_normals(cage.is_regular);
    return cage;
}

const Cage& SubdivisionMesh::cage() const {
    std::optional<Cage>& cage = implementation_->known_cage;
    if (!cage) cage = implementation_->make_cage();
    return *cage;
}

LimitFace SubdivisionMesh::make_face(uint32_t face) const {
    const Implementation& self = *implementation_;
    if (!self.is_bicubic.empty() && self.is_bicubic[face]) {
        const osd::Far::TopologyLevel base = self.refiner->GetLevel(0);
        return LimitFace(self.find_controls(face, [&](int other, int k) {
            return read(&self.positions[3 * size_t(base.GetFaceVertices(other)[k])]);
        }));
    }
    const auto [irregular, is_bicubic_apart] = self.find_irregular_corners(face);
    if (!self.kept_faces.empty() && self.kept_faces[face])
        return LimitFace(self.kept_faces[face], irregular, is_bicubic_apart);
    auto limit = std::make_shared<LimitFace::Surface>();
    if (!self.factory->InitVertexSurface(int(face), &limit->surface))
        throw Error(ErrorKind::bad_input,
                    {"a face has no limit surface", fmt::format("{}, face {}", self.where, face),
                     "repair the mesh, or set the subdivision scheme to none"});
    limit->points.resize(3 * size_t(limit->surface.GetNumPatchPoints()));
    limit->surface.PreparePatchPoints(self.positions.data(), 3, limit->points.data(), 3);
    limit->parameters = limit->surface.GetParameterization();
    if (!self.kept_faces.empty()) self.kept_faces[face] = limit;
    return LimitFace(std::move(limit), irregular, is_bicubic_apart);
}

LimitFace SubdivisionMesh::make_uv_face(uint32_t face, uint32_t set) const {
    return implementation_->make_uv_face(face, int(set));
}

bool SubdivisionMesh::has_smooth_uvs() const { return implementation_->has_smooth_uvs; }

} // namespace relief
