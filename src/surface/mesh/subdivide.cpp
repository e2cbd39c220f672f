#include "surface/mesh/subdivide.h"

#include <cmath>
#include <numeric>
#include <optional>

#include "surface/mesh/adaptive_cage.h"
#include "surface/mesh/irregular_points.h"
#include "surface/mesh/limit_patches.h"
#include "surface/mesh/subdivision_mesh.h"

namespace relief {

namespace {

/// Corners (4 quad + k) around each point, point by point.
struct PointCorners {
    std::vector<uint32_t> starts, corners;
};

PointCorners find_corners(const RefinedMesh& refined) {
    PointCorners result;
    result.starts.assign(refined.point_count + 1, 0);
    for (const auto& quad : refined.points)
        for (const uint32_t point : quad) ++result.starts[point + 1];
    std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
    result.corners.resize(4 * refined.points.size());
    std::vector<uint32_t> next(result.starts.begin(), result.starts.end() - 1);
    for (uint32_t corner = 0; corner < result.corners.size(); ++corner)
        result.corners[next[refined.points[corner / 4][corner & 3]]++] = corner;
    return result;
}

/// True where two corners of a point share an edge that is not sharp.
bool are_joined(const RefinedMesh& refined, uint32_t a, uint32_t b) {
    for (const uint32_t ka : {a & 3, (a + 3) & 3})
        for (const uint32_t kb : {b & 3, (b + 3) & 3}) {
            const uint32_t edge = refined.edges[a / 4][ka];
            if (edge == refined.edges[b / 4][kb] && !refined.is_sharp[edge]) return true;
        }
    return false;
}

/// Numbers the sides of creases around a point: corners of equal number have one normal.
std::vector<uint32_t> find_sides(const RefinedMesh& refined, const uint32_t* corners, size_t count) {
    std::vector<uint32_t> side(count, kNoIndex), pending;
    uint32_t side_count = 0;
    for (size_t first = 0; first < count; ++first) {
        if (side[first] != kNoIndex) continue;
        side[first] = side_count;
        pending.push_back(uint32_t(first));
        while (!pending.empty()) {
            const uint32_t from = pending.back();
            pending.pop_back();
            for (size_t to = 0; to < count; ++to) {
                if (side[to] != kNoIndex || !are_joined(refined, corners[from], corners[to])) continue;
                side[to] = side_count;
                pending.push_back(uint32_t(to));
            }
        }
        ++side_count;
    }
    return side;
}

Vec3f normalize_sum(const Vec3d& sum) {
    const double size = std::sqrt(dot(sum, sum));
    if (!(size > 0)) return {0, 0, 1};
    return {float(sum.x / size), float(sum.y / size), float(sum.z / size)};
}

/// Means of the corners' normals, by side and by point.
void join_normals(const RefinedMesh& refined, const LimitPatches& patches, SmoothBase& base) {
    const PointCorners around = find_corners(refined);
    base.polygons.normals.resize(4 * refined.points.size());
    base.point_normals.resize(refined.point_count);
    std::vector<Vec3d> sums;
    for (uint32_t point = 0; point < refined.point_count; ++point) {
        const uint32_t* corners = around.corners.data() + around.starts[point];
        const size_t count = around.starts[point + 1] - around.starts[point];
        const std::vector<uint32_t> sides = find_sides(refined, corners, count);
        sums.assign(count, Vec3d{});
        Vec3d whole{};
        for (size_t c = 0; c < count; ++c) {
            const Vec3d normal = to_double(patches.corner_normals[corners[c] / 4][corners[c] & 3]);
            sums[sides[c]] += normal;
            whole += normal;
        }
        for (size_t c = 0; c < count; ++c) base.polygons.normals[corners[c]] = normalize_sum(sums[sides[c]]);
        base.point_normals[point] = normalize_sum(whole);
    }
}

/// Faces and uvs of the refined mesh; `source_faces` are those of the polygons that it was refined from.
Polygons make_quads(const RefinedMesh& refined, const Polygons& source) {
    Polygons polygons;
    polygons.where = source.where;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad) {
        polygons.starts.push_back(4 * quad);
        polygons.points.insert(polygons.points.end(), refined.points[quad].begin(),
                               refined.points[quad].end());
        if (!refined.uvs.empty())
            polygons.uvs.insert(polygons.uvs.end(), refined.uvs[quad].begin(), refined.uvs[quad].end());
        polygons.source_faces.push_back(source.source_faces[refined.places[quad].face]);
    }
    for (size_t n = 0; n < source.further_uvs.size(); ++n) {
        CornerUvs& set = polygons.further_uvs.emplace_back(CornerUvs{source.further_uvs[n].number, {}});
        for (const std::array<Vec2f, 4>& uvs : refined.further_uvs[n])
            set.uvs.insert(set.uvs.end(), uvs.begin(), uvs.end());
    }
    polygons.starts.push_back(4 * refined.quad_count());
    return polygons;
}

RefinedMesh refine_to_level(SubdivisionMesh& mesh, const Polygons& polygons, const Subdivision& subdivision,
                            const BaseNeeds& needs) {
    RefinedMesh refined = mesh.refine(polygons.where);
    if (needs.patches == BasePatches::bicubic && subdivision.scheme == SubdivisionScheme::catmark)
        cut_at_irregular_points(refined, kIsolationDepth);
    return refined;
}

} // namespace

SmoothBase subdivide(const Polygons& polygons, const Subdivision& subdivision, const BaseNeeds& needs) {
    const bool is_automatic =
        subdivision.level == kAutoSubdivisionLevel && subdivision.scheme == SubdivisionScheme::catmark;
    std::optional<SubdivisionMesh> own;
    if (!is_automatic || !needs.limit) own.emplace(polygons, subdivision);
    const SubdivisionMesh& mesh = own ? *own : *needs.limit;
    SmoothBase base;
    const RefinedMesh refined = is_automatic ? refine_adaptively(mesh, polygons, needs, base.reserve)
                                             : refine_to_level(*own, polygons, subdivision, needs);
    base.polygons = make_quads(refined, polygons);
    if (subdivision.scheme == SubdivisionScheme::bilinear) {
        base.polygons.positions = mesh.compute_points();
        base.places = refined.places;
        return base;
    }
    LimitPatches patches = make_limit_patches(mesh, refined, needs.patches == BasePatches::bicubic);
    join_normals(refined, patches, base);
    base.polygons.positions = std::move(patches.positions);
    base.controls = std::move(patches.controls);
    return base;
}

} // namespace relief
