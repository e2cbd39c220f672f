// Cages of subdivision meshes, and what is known about their points.
#include "surface/mesh/cage.h"

#include "base/parallel.h"
#include "surface/mesh/subdivision_topology.h"

namespace relief {

bool has_quads_only(const osd::Far::TopologyLevel& level, int point) {
    for (const int face : level.GetVertexFaces(point))
        if (level.GetFaceVertices(face).size() != 4) return false;
    return true;
}

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
    cage.side_fits.assign(cage.is_sharp.size(), kNoIndex);
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

} // namespace relief
