#include "surface/mesh/subdivision_mesh.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include <fmt/format.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "relief/error.h"
#include "surface/mesh/patch_budget.h"
#include "surface/mesh/subdivision_topology.h"

namespace relief {

namespace {

/// Steps beyond the patches, and beyond the creases, that the surface beside irregular points is isolated by.
constexpr int kStepsBeyond = 7;
constexpr int kMostSteps = 10;
/// The same of uvs where faces are cut no finer than a tolerance asks for: maps are read between texels.
constexpr int kStepsOfUvs = 4;
/// Quads, and parts of polygons, whose limit surfaces are kept, with 5 to 12 kB each.
constexpr uint64_t kMostKept = 1 << 14;

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

} // namespace

bool is_smooth_point(const osd::Far::TopologyLevel& level, int point) {
    if (level.IsVertexNonManifold(point) || level.IsVertexBoundary(point)) return false;
    if (level.GetVertexSharpness(point) > 0) return false;
    for (const int edge : level.GetVertexEdges(point))
        if (level.GetEdgeSharpness(edge) > 0) return false;
    return true;
}

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
    // What is irregular where creases meet stays so when they have worn off.
    const int start = std::max(self.level, int(std::ceil(creases.largest_semi_sharp)));
    const bool is_automatic = subdivision.level == kAutoSubdivisionLevel;
    const auto make_factory = [&](int steps_beyond, std::optional<Factory>& factory) {
        Factory::Options options;
        options.SetApproxLevelSmooth(std::min(start + steps_beyond, kMostSteps));
        options.SetApproxLevelSharp(std::min(start + steps_beyond, kMostSteps));
        factory.emplace(*self.refiner, options);
    };
    make_factory(kStepsBeyond, self.factory);
    make_factory(is_automatic ? kStepsOfUvs : kStepsBeyond, self.uv_factory);
    self.has_smooth_uvs =
        subdivision.uv == UvRule::smooth && subdivision.scheme == SubdivisionScheme::catmark;
    for (const UvTopology& set : self.uv_sets) {
        std::vector<double>& points = self.uv_points.emplace_back();
        for (const Vec2f& uv : set.values) points.insert(points.end(), {uv.x, uv.y, 0});
    }
    if (subdivision.scheme == SubdivisionScheme::catmark) self.find_bicubic_faces();
    if (self.has_smooth_uvs && self.level <= 1) self.find_spline_uvs();
    uint64_t irregular_parts = 0;
    for (uint32_t face = 0; face < self.is_bicubic.size(); ++face)
        if (!self.is_bicubic[face])
            irregular_parts += polygons.face_size(face) == 4 ? 1 : polygons.face_size(face);
    if (is_automatic && irregular_parts <= kMostKept) {
        self.kept_faces.resize(polygons.face_count());
        self.kept_uv_faces.assign(self.uv_sets.size(), self.kept_faces);
    }
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

/// Limits of the uv values of the refined mesh.
std::vector<Vec2f> SubdivisionMesh::Implementation::find_limit_uv_values(int channel) const {
    const osd::Far::PrimvarRefinerReal<double> primvars(*refiner);
    std::vector<BlendedUv> base;
    for (const Vec2f& uv : uv_sets[size_t(channel)].values) base.push_back({{uv.x, uv.y}});
    const std::vector<BlendedUv> refined = refine_values(
        std::move(base), refiner->GetMaxLevel(),
        [&](int k) { return refiner->GetLevel(k).GetNumFVarValues(channel); },
        [&](int k, const auto& from, auto& to) { primvars.InterpolateFaceVarying(k, from, to, channel); });
    std::vector<BlendedUv> limit(refined.size());
    primvars.LimitFaceVarying(refined, limit, channel);
    std::vector<Vec2f> values;
    values.reserve(limit.size());
    for (const BlendedUv& uv : limit) values.push_back({float(uv.value.x), float(uv.value.y)});
    return values;
}

std::vector<Vec2f> SubdivisionMesh::Implementation::find_limit_uvs(int channel) const {
    const std::vector<Vec2f> values =
        refiner->GetMaxLevel() == 0 ? find_base_uv_values(channel) : find_limit_uv_values(channel);
    const osd::Far::TopologyLevel last = refiner->GetLevel(refiner->GetMaxLevel());
    std::vector<Vec2f> uvs;
    for (int face = 0; face < last.GetNumFaces(); ++face)
        for (const int value : last.GetFaceFVarValues(face, channel)) uvs.push_back(values[size_t(value)]);
    return uvs;
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
        const std::vector<Vec2f> corners = find_limit_uvs(int(k));
        std::vector<std::array<Vec2f, 4>> uvs(quad_count);
        for (size_t corner = 0; corner < corners.size(); ++corner)
            uvs[corner / 4][corner & 3] = corners[corner];
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
        std::move(base), refiner->GetMaxLevel(), [&](int k) { return refiner->GetLevel(k).GetNumVertices(); },
        [&](int k, const auto& from, auto& to) { primvars.Interpolate(k, from, to); });
}

/// The surface of a face is isolated to some depth only, which its normals at irregular points show.
std::vector<Vec3d>
SubdivisionMesh::Implementation::find_limit_normals(const std::vector<bool>& is_regular) const {
    const osd::Far::TopologyLevel last = refiner->GetLevel(refiner->GetMaxLevel());
    const std::vector<BlendedPoint> points = refine_points();
    std::vector<BlendedPoint> limit(points.size()), first(points.size()), second(points.size());
    osd::Far::PrimvarRefinerReal<double>(*refiner).Limit(points, limit, first, second);
    std::vector<Vec3d> normals(points.size());
    for (size_t point = 0; point < points.size(); ++point)
        if (!is_regular[point] && is_smooth_point(last, int(point)))
            normals[point] = normalize_double(cross(first[point].value, second[point].value));
    return normals;
}

RefinedMesh SubdivisionMesh::refine(const std::string& where) {
    Implementation& self = *implementation_;
    check_patch_count(quad_count(), where, fmt::format("subdivision to level {}", self.level));
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

} // namespace relief
