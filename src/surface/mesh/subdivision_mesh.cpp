#include "surface/mesh/subdivision_mesh.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "relief/error.h"
#include "surface/mesh/uv_topology.h"

namespace relief {

namespace {

namespace osd = OpenSubdiv;

using Cache = osd::Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                                    std::unique_lock<std::shared_mutex>>;
using Factory = osd::Bfr::RefinerSurfaceFactory<Cache>;
using RefinerPointer = std::unique_ptr<osd::Far::TopologyRefiner>;

/// Steps beyond the patches, and beyond the creases, that the surface beside irregular points is isolated by.
constexpr int kStepsBeyond = 7;
constexpr int kMostSteps = 10;

/// What OpenSubdiv complained of last, which it would print otherwise.
thread_local std::string complaint;

void keep_error(osd::Far::ErrorType, const char* message) { complaint = message; }
void keep_warning(const char* message) { complaint = message; }

void keep_complaints() {
    static std::once_flag once;
    std::call_once(once, [] {
        osd::Far::SetErrorCallback(keep_error);
        osd::Far::SetWarningCallback(keep_warning);
    });
    complaint.clear();
}

osd::Sdc::Options make_options(const Subdivision& subdivision) {
    osd::Sdc::Options options;
    options.SetVtxBoundaryInterpolation(subdivision.boundary == BoundaryRule::edge_only
                                            ? osd::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                            : osd::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    options.SetFVarLinearInterpolation(subdivision.uv == UvRule::linear
                                           ? osd::Sdc::Options::FVAR_LINEAR_ALL
                                           : osd::Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    return options;
}

struct CreaseLists {
    std::vector<int> ends, corners;
    std::vector<float> edge_sharpness, corner_sharpness;
    float largest_semi_sharp = 0;
};

CreaseLists list_creases(const Polygons& polygons) {
    CreaseLists lists;
    for (const Crease& crease : polygons.creases) {
        const float sharpness = std::min(crease.sharpness, kInfiniteSharpness);
        if (sharpness < kInfiniteSharpness)
            lists.largest_semi_sharp = std::max(lists.largest_semi_sharp, sharpness);
        if (crease.first == crease.second) {
            lists.corners.push_back(int(crease.first));
            lists.corner_sharpness.push_back(sharpness);
        } else {
            lists.ends.insert(lists.ends.end(), {int(crease.first), int(crease.second)});
            lists.edge_sharpness.push_back(sharpness);
        }
    }
    return lists;
}

/// Fails where a face comes back to one of its points: OpenSubdiv would follow its edges in circles.
void check_faces(const Polygons& polygons) {
    std::vector<uint32_t> points;
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        points.assign(polygons.points.begin() + polygons.starts[face],
                      polygons.points.begin() + polygons.starts[face + 1]);
        std::sort(points.begin(), points.end());
        if (std::adjacent_find(points.begin(), points.end()) == points.end()) continue;
        throw Error(ErrorKind::bad_input,
                    {"cannot be subdivided: the face comes back to one of its points",
                     fmt::format("{}, face {}", polygons.where, polygons.source_faces[face]),
                     "cut the face in two"});
    }
}

/// Fails where OpenSubdiv does not take the topology.
RefinerPointer make_refiner(const Polygons& polygons, const Subdivision& subdivision,
                            const std::vector<UvTopology>& uv_sets, const CreaseLists& creases) {
    std::vector<int> sizes;
    const std::vector<int> points(polygons.points.begin(), polygons.points.end());
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        sizes.push_back(int(polygons.face_size(face)));
    std::vector<osd::Far::TopologyDescriptor::FVarChannel> channels(uv_sets.size());
    for (size_t k = 0; k < uv_sets.size(); ++k) {
        channels[k].numValues = int(uv_sets[k].values.size());
        channels[k].valueIndices = uv_sets[k].indices.data();
    }
    osd::Far::TopologyDescriptor descriptor;
    descriptor.numVertices = int(polygons.positions.size());
    descriptor.numFaces = int(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = points.data();
    descriptor.numCreases = int(creases.edge_sharpness.size());
    descriptor.creaseVertexIndexPairs = creases.ends.data();
    descriptor.creaseWeights = creases.edge_sharpness.data();
    descriptor.numCorners = int(creases.corners.size());
    descriptor.cornerVertexIndices = creases.corners.data();
    descriptor.cornerWeights = creases.corner_sharpness.data();
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();

    using RefinerFactory = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
    const auto scheme = subdivision.scheme == SubdivisionScheme::bilinear ? osd::Sdc::SCHEME_BILINEAR
                                                                          : osd::Sdc::SCHEME_CATMARK;
    keep_complaints();
    RefinerPointer refiner(
        RefinerFactory::Create(descriptor, RefinerFactory::Options(scheme, make_options(subdivision))));
    if (!refiner)
        throw Error(ErrorKind::bad_input, {"cannot be subdivided: " + complaint, polygons.where,
                                           "repair the mesh, or set the subdivision scheme to none"});
    return refiner;
}

/// What primvars of OpenSubdiv must be able to do.
template <class Value> struct Blended {
    Value value{};
    void Clear(void* = nullptr) { value = Value{}; }
    void AddWithWeight(const Blended& other, double weight) { value = value + other.value * weight; }
};
using BlendedUv = Blended<Vec2<double>>;
using BlendedPoint = Blended<Vec3d>;

Vec3d read(const double* p) { return {p[0], p[1], p[2]}; }
bool is_semi_sharp(float sharpness) { return sharpness > 0 && sharpness < kInfiniteSharpness; }

/// True where the quads around a point are bicubic on each side of what stays sharp.
bool is_regular_point(const osd::Far::TopologyLevel& level, int point) {
    if (level.IsVertexNonManifold(point)) return false;
    const float sharpness = level.GetVertexSharpness(point);
    if (is_semi_sharp(sharpness)) return false;
    const osd::Far::ConstIndexArray edges = level.GetVertexEdges(point);
    std::vector<int> sharp;
    for (int k = 0; k < edges.size(); ++k) {
        const float edge_sharpness = level.GetEdgeSharpness(edges[k]);
        if (is_semi_sharp(edge_sharpness)) return false;
        if (edge_sharpness > 0) sharp.push_back(k);
    }
    if (level.IsVertexBoundary(point))
        return sharp.size() == 2 && (sharpness > 0 ? edges.size() == 2 : edges.size() == 3);
    return edges.size() == 4 && sharpness == 0 &&
           (sharp.empty() || (sharp.size() == 2 && sharp[1] - sharp[0] == 2));
}

/// True where one semi-sharp crease, which does not change, is all that keeps a point from being regular.
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

bool is_smooth_point(const osd::Far::TopologyLevel& level, int point) {
    if (level.IsVertexNonManifold(point) || level.IsVertexBoundary(point)) return false;
    if (level.GetVertexSharpness(point) > 0) return false;
    for (const int edge : level.GetVertexEdges(point))
        if (level.GetEdgeSharpness(edge) > 0) return false;
    return true;
}

/// Cell (i, j) of a face or part, and its axes.
struct CellOrigin {
    uint32_t face = 0, part = 0, i = 0, j = 0;
};

/// Corner k of a quad stands at (u, v) = kCorner[k].
constexpr std::array<std::array<uint32_t, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

} // namespace

struct LimitFace::Surface {
    osd::Bfr::Surface<double> surface;
    std::vector<double> points;
    osd::Bfr::Parameterization parameters;
};

LimitFace::LimitFace(std::unique_ptr<Surface> surface) : surface_(std::move(surface)) {}
LimitFace::~LimitFace() = default;

LimitSample LimitFace::evaluate(uint32_t part, double u, double v) const {
    double place[2] = {u, v}, scale = 1;
    if (surface_->parameters.HasSubFaces()) {
        const double in_part[2] = {u, v};
        surface_->parameters.ConvertNormalizedSubFaceToCoord(int(part), in_part, place);
        scale = 0.5;
    }
    double p[3], du[3], dv[3], duu[3], duv[3], dvv[3];
    surface_->surface.Evaluate(place, surface_->points.data(), 3, p, du, dv, duu, duv, dvv);
    return {read(p), read(du) * scale, read(dv) * scale, read(duv) * (scale * scale)};
}

struct SubdivisionMesh::Implementation {
    std::string where;
    int level = 0;
    std::vector<UvTopology> uv_sets; ///< a channel each: first that of the mesh, if it has one
    bool has_uvs = false;            ///< it has one
    std::vector<double> positions;
    RefinerPointer refiner;
    std::optional<Factory> factory;

    void check_edges(const Polygons& polygons) const;
    void check_points(const Polygons& polygons) const;
    void check_creases(const Polygons& polygons) const;
    int get_depth(uint32_t face) const;
    std::vector<CellOrigin> find_origins() const;
    std::vector<QuadPlace> find_places() const;
    std::vector<std::array<Vec2f, 4>> refine_uvs(int channel) const;
    std::vector<BlendedPoint> refine_points() const;
    std::vector<Vec3d> find_limit_normals(const std::vector<bool>& is_regular) const;
    void copy_quads(RefinedMesh& refined) const;
};

void SubdivisionMesh::Implementation::check_edges(const Polygons& polygons) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        if (!base.IsEdgeNonManifold(edge)) continue;
        const osd::Far::ConstIndexArray ends = base.GetEdgeVertices(edge), faces = base.GetEdgeFaces(edge);
        const Vec3f &a = polygons.positions[uint32_t(ends[0])], &b = polygons.positions[uint32_t(ends[1])];
        throw Error(ErrorKind::bad_input,
                    {fmt::format("cannot be subdivided: the edge from ({}, {}, {}) to ({}, {}, {}) has {}",
                                 a.x, a.y, a.z, b.x, b.y, b.z,
                                 faces.size() > 2 ? fmt::format("{} faces", faces.size())
                                                  : std::string("faces that are turned against each other")),
                     fmt::format("{}, face {}", where,
                                 faces.size() > 0 ? polygons.source_faces[uint32_t(faces[0])] : 0),
                     "take the faces apart, or make all of them counter-clockwise"});
    }
}

/// OpenSubdiv 3.5 makes no limit surface beside such points, with creases around it goes astray.
void SubdivisionMesh::Implementation::check_points(const Polygons& polygons) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    for (int point = 0; point < base.GetNumVertices(); ++point) {
        const osd::Far::ConstIndexArray faces = base.GetVertexFaces(point);
        if (faces.size() == 0) continue; // joined with another, or never used
        const bool is_pinched = base.IsVertexNonManifold(point);
        const bool is_between_two = !polygons.creases.empty() && !base.IsVertexBoundary(point) &&
                                    base.GetVertexEdges(point).size() == 2;
        if (!is_pinched && !is_between_two) continue;
        const Vec3f& p = polygons.positions[uint32_t(point)];
        throw Error(
            ErrorKind::bad_input,
            {fmt::format("cannot be subdivided: {} at ({}, {}, {})",
                         is_pinched ? "parts that share no edge meet" : "two faces share both of their edges",
                         p.x, p.y, p.z),
             fmt::format("{}, face {}", where, polygons.source_faces[uint32_t(faces[0])]),
             is_pinched ? "move the parts a little apart, or join them" : "dissolve the point"});
    }
}

void SubdivisionMesh::Implementation::check_creases(const Polygons& polygons) const {
    const osd::Far::TopologyLevel base = refiner->GetLevel(0);
    for (const Crease& crease : polygons.creases)
        if (crease.first != crease.second &&
            base.FindEdge(int(crease.first), int(crease.second)) == osd::Far::INDEX_INVALID)
            throw Error(
                ErrorKind::bad_input,
                {fmt::format("crease from point {} to {} is along no edge", crease.first, crease.second),
                 where, "points count from 0; remove the crease, or ignore all with \"creases\": false"});
}

SubdivisionMesh::SubdivisionMesh(const Polygons& polygons, const Subdivision& subdivision)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    check_faces(polygons);
    self.where = polygons.where;
    self.has_uvs = !polygons.uvs.empty();
    if (self.has_uvs) self.uv_sets.push_back(join_uvs(polygons, polygons.uvs));
    for (const CornerUvs& set : polygons.further_uvs) self.uv_sets.push_back(join_uvs(polygons, set.uvs));
    for (const Vec3f& p : polygons.positions) self.positions.insert(self.positions.end(), {p.x, p.y, p.z});
    bool is_all_quads = true;
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        is_all_quads = is_all_quads && polygons.face_size(face) == 4;
    self.level = std::max(subdivision.level, is_all_quads ? 0 : 1);

    const CreaseLists creases = list_creases(polygons);
    self.refiner = make_refiner(polygons, subdivision, self.uv_sets, creases);
    self.check_edges(polygons);
    self.check_points(polygons);
    self.check_creases(polygons);
    Factory::Options options;
    // What is irregular where creases meet stays so when they have worn off.
    const int start = std::max(self.level, int(std::ceil(creases.largest_semi_sharp)));
    const int steps = std::min(start + kStepsBeyond, kMostSteps);
    options.SetApproxLevelSmooth(steps);
    options.SetApproxLevelSharp(steps);
    self.factory.emplace(*self.refiner, options);
}

SubdivisionMesh::~SubdivisionMesh() = default;

int SubdivisionMesh::level() const { return implementation_->level; }

/// Steps that the parts of a face are refined by.
int SubdivisionMesh::Implementation::get_depth(uint32_t face) const {
    return level - (refiner->GetLevel(0).GetFaceVertices(int(face)).size() == 4 ? 0 : 1);
}

uint64_t SubdivisionMesh::quad_count() const {
    const osd::Far::TopologyLevel base = implementation_->refiner->GetLevel(0);
    uint64_t count = 0;
    for (int face = 0; face < base.GetNumFaces(); ++face) {
        const int size = base.GetFaceVertices(face).size();
        count += uint64_t(size == 4 ? 1 : size) << 2 * implementation_->get_depth(uint32_t(face));
    }
    return count;
}

/// Follows the faces from level to level.
std::vector<CellOrigin> SubdivisionMesh::Implementation::find_origins() const {
    std::vector<CellOrigin> origins(size_t(refiner->GetLevel(0).GetNumFaces()));
    for (uint32_t face = 0; face < origins.size(); ++face) origins[face].face = face;
    for (int step = 0; step < level; ++step) {
        const osd::Far::TopologyLevel parents = refiner->GetLevel(step);
        std::vector<CellOrigin> children(size_t(refiner->GetLevel(step + 1).GetNumFaces()));
        for (int face = 0; face < parents.GetNumFaces(); ++face) {
            const osd::Far::ConstIndexArray own = parents.GetFaceChildFaces(face);
            const CellOrigin& origin = origins[size_t(face)];
            for (int k = 0; k < own.size(); ++k) {
                CellOrigin& child = children[size_t(own[k])];
                child = origin;
                if (parents.GetFaceVertices(face).size() == 4) {
                    child.i = 2 * origin.i + kCorner[size_t(k)][0];
                    child.j = 2 * origin.j + kCorner[size_t(k)][1];
                } else {
                    child.part = uint32_t(k);
                }
            }
        }
        origins = std::move(children);
    }
    return origins;
}

std::vector<QuadPlace> SubdivisionMesh::Implementation::find_places() const {
    std::vector<QuadPlace> places;
    for (const CellOrigin& origin : find_origins()) {
        const double side = std::ldexp(1.0, -get_depth(origin.face));
        QuadPlace& place = places.emplace_back(QuadPlace{origin.face, origin.part, {}});
        for (size_t k = 0; k < 4; ++k)
            place.corners[k] = {(origin.i + kCorner[k][0]) * side, (origin.j + kCorner[k][1]) * side};
    }
    return places;
}

/// Values of level 0 carried to `level`; `count` and `step` are of one level.
template <class Value, class Count, class Step>
std::vector<Blended<Value>> refine_values(std::vector<Blended<Value>> values, int level, const Count& count,
                                          const Step& step) {
    for (int k = 1; k <= level; ++k) {
        std::vector<Blended<Value>> next(size_t(count(k)));
        step(k, values, next);
        values = std::move(next);
    }
    return values;
}

/// Uvs of the corners of the quads at `level`.
std::vector<std::array<Vec2f, 4>> SubdivisionMesh::Implementation::refine_uvs(int channel) const {
    const osd::Far::PrimvarRefinerReal<double> primvars(*refiner);
    std::vector<BlendedUv> base;
    for (const Vec2f& uv : uv_sets[size_t(channel)].values) base.push_back({{uv.x, uv.y}});
    const std::vector<BlendedUv> refined = refine_values(
        std::move(base), level, [&](int k) { return refiner->GetLevel(k).GetNumFVarValues(channel); },
        [&](int k, const auto& from, auto& to) { primvars.InterpolateFaceVarying(k, from, to, channel); });
    std::vector<BlendedUv> limit(refined.size());
    primvars.LimitFaceVarying(refined, limit, channel);
    const osd::Far::TopologyLevel last = refiner->GetLevel(level);
    std::vector<std::array<Vec2f, 4>> result(size_t(last.GetNumFaces()));
    for (size_t quad = 0; quad < result.size(); ++quad) {
        const osd::Far::ConstIndexArray values = last.GetFaceFVarValues(int(quad), channel);
        for (size_t k = 0; k < 4; ++k) {
            const Vec2<double>& uv = limit[size_t(values[int(k)])].value;
            result[quad][k] = {float(uv.x), float(uv.y)};
        }
    }
    return result;
}

void SubdivisionMesh::Implementation::copy_quads(RefinedMesh& refined) const {
    const osd::Far::TopologyLevel last = refiner->GetLevel(level);
    const auto quad_count = uint32_t(last.GetNumFaces());
    refined.first_quads.assign(size_t(last.GetNumEdges()), kNoIndex);
    refined.points.resize(quad_count), refined.edges.resize(quad_count);
    for (uint32_t quad = 0; quad < quad_count; ++quad) {
        const auto points = last.GetFaceVertices(int(quad)), edges = last.GetFaceEdges(int(quad));
        for (size_t k = 0; k < 4; ++k) {
            refined.points[quad][k] = uint32_t(points[int(k)]);
            refined.edges[quad][k] = uint32_t(edges[int(k)]);
            uint32_t& first = refined.first_quads[size_t(edges[int(k)])];
            first = std::min(first, quad);
        }
    }
    for (size_t k = 0; k < uv_sets.size(); ++k) {
        std::vector<std::array<Vec2f, 4>> uvs = refine_uvs(int(k));
        if (k == 0 && has_uvs)
            refined.uvs = std::move(uvs);
        else
            refined.further_uvs.push_back(std::move(uvs));
    }
}

std::vector<BlendedPoint> SubdivisionMesh::Implementation::refine_points() const {
    const osd::Far::PrimvarRefinerReal<double> primvars(*refiner);
    std::vector<BlendedPoint> base;
    for (size_t k = 0; k < positions.size(); k += 3) base.push_back({read(&positions[k])});
    return refine_values(
        std::move(base), level, [&](int k) { return refiner->GetLevel(k).GetNumVertices(); },
        [&](int k, const auto& from, auto& to) { primvars.Interpolate(k, from, to); });
}

/// The surface of a face is isolated to some depth only, which its normals at irregular points show.
std::vector<Vec3d>
SubdivisionMesh::Implementation::find_limit_normals(const std::vector<bool>& is_regular) const {
    const osd::Far::TopologyLevel last = refiner->GetLevel(level);
    const std::vector<BlendedPoint> points = refine_points();
    std::vector<BlendedPoint> limit(points.size()), first(points.size()), second(points.size());
    osd::Far::PrimvarRefinerReal<double>(*refiner).Limit(points, limit, first, second);
    std::vector<Vec3d> normals(points.size());
    for (size_t point = 0; point < points.size(); ++point)
        if (!is_regular[point] && is_smooth_point(last, int(point)))
            normals[point] = normalize_double(cross(first[point].value, second[point].value));
    return normals;
}

RefinedMesh SubdivisionMesh::refine() {
    Implementation& self = *implementation_;
    osd::Far::TopologyRefiner::UniformOptions options(self.level);
    options.fullTopologyInLastLevel = true;
    self.refiner->RefineUniform(options);
    const osd::Far::TopologyLevel last = self.refiner->GetLevel(self.level);
    RefinedMesh refined;
    refined.point_count = uint32_t(last.GetNumVertices());
    refined.places = self.find_places();
    self.copy_quads(refined);
    for (int edge = 0; edge < last.GetNumEdges(); ++edge) {
        const float sharpness = last.GetEdgeSharpness(edge);
        refined.is_sharp.push_back(sharpness >= kInfiniteSharpness);
        refined.semi_sharpness.push_back(is_semi_sharp(sharpness) ? sharpness : 0.0f);
    }
    refined.is_bent.assign(refined.is_sharp.size(), false);
    for (int point = 0; point < last.GetNumVertices(); ++point) {
        refined.is_regular.push_back(is_regular_point(last, point));
        refined.is_straight.push_back(is_straight_point(last, point));
        const float sharpness = last.GetVertexSharpness(point);
        refined.point_sharpness.push_back(is_semi_sharp(sharpness) ? sharpness : 0.0f);
    }
    refined.limit_normals = self.find_limit_normals(refined.is_regular);
    return refined;
}

std::vector<Vec3f> SubdivisionMesh::compute_points() const {
    std::vector<Vec3f> result;
    for (const BlendedPoint& point : implementation_->refine_points())
        result.push_back(to_float(point.value));
    return result;
}

LimitFace SubdivisionMesh::make_face(uint32_t face) const {
    const Implementation& self = *implementation_;
    auto limit = std::make_unique<LimitFace::Surface>();
    if (!self.factory->InitVertexSurface(int(face), &limit->surface))
        throw Error(ErrorKind::bad_input,
                    {"a face has no limit surface", fmt::format("{}, face {}", self.where, face),
                     "repair the mesh, or set the subdivision scheme to none"});
    limit->points.resize(3 * size_t(limit->surface.GetNumPatchPoints()));
    limit->surface.PreparePatchPoints(self.positions.data(), 3, limit->points.data(), 3);
    limit->parameters = limit->surface.GetParameterization();
    return LimitFace(std::move(limit));
}

} // namespace relief
