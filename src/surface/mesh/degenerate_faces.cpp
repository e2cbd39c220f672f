#include "surface/mesh/degenerate_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "math/vec.h"
#include "relief/error.h"
#include "surface/mesh/join_points.h"

namespace relief {

namespace {

/// Of the square of the longest edge: rounding of collinear corners.
constexpr double kSmallestAreaRatio = 1e-12;

using Edge = std::pair<uint32_t, uint32_t>;

/// The faces that have no area, 1 each.
std::vector<uint8_t> mark_degenerate(const Polygons& polygons) {
    std::vector<uint8_t> marks(polygons.face_count());
    std::vector<Vec3f> corners;
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        corners.clear();
        for (uint32_t k = polygons.starts[face]; k < polygons.starts[face + 1]; ++k)
            corners.push_back(polygons.positions[polygons.points[k]]);
        marks[face] = has_area(corners) ? 0 : 1;
    }
    return marks;
}

/// Decides which corners of dropped faces go into edges of faces that stay.
class Splicer {
  public:
    Splicer(const Polygons& polygons, const std::vector<uint8_t>& is_dropped)
        : polygons_(polygons), numbers_(find_equal_points(polygons.positions)) {
        for (uint32_t face = 0; face < polygons.face_count(); ++face)
            for (uint32_t k = 0; !is_dropped[face] && k < polygons.face_size(face); ++k)
                corner_of_edge_.try_emplace(get_edge(face, k), polygons.starts[face] + k);
    }

    void splice(uint32_t face) {
        const uint32_t size = polygons_.face_size(face);
        if (size < 3) return;
        uint32_t longest = 0;
        for (uint32_t k = 1; k < size; ++k)
            if (get_length(face, k) > get_length(face, longest)) longest = k;
        const auto [end, begin] = get_edge(face, longest);
        const auto neighbour = corner_of_edge_.find({begin, end});
        if (neighbour == corner_of_edge_.end()) return;
        const double whole = get_length(face, longest);
        std::vector<PointOnWay> points;
        double reached = 0;
        for (uint32_t k = longest + 1; k + 1 < longest + size; ++k) {
            reached += get_length(face, k % size);
            if (!(reached < whole)) return; // the corners turn back: no order along the edge
            points.push_back(
                {polygons_.points[polygons_.starts[face] + (k + 1) % size], float(reached / whole)});
        }
        points_of_corner_[neighbour->second] = std::move(points);
    }

    /// What goes between a corner and the next one of its face.
    const std::vector<PointOnWay>& find(uint32_t corner) const {
        static const std::vector<PointOnWay> kNone;
        const auto found = points_of_corner_.find(corner);
        return found == points_of_corner_.end() ? kNone : found->second;
    }

  private:
    uint32_t get_point(uint32_t face, uint32_t k) const {
        return polygons_.points[polygons_.starts[face] + k % polygons_.face_size(face)];
    }
    Edge get_edge(uint32_t face, uint32_t k) const {
        return {numbers_[get_point(face, k)], numbers_[get_point(face, k + 1)]};
    }
    double get_length(uint32_t face, uint32_t k) const {
        return length(polygons_.positions[get_point(face, k + 1)] - polygons_.positions[get_point(face, k)]);
    }

    const Polygons& polygons_;
    std::vector<uint32_t> numbers_;
    std::map<Edge, uint32_t> corner_of_edge_;
    std::map<uint32_t, std::vector<PointOnWay>> points_of_corner_;
};

} // namespace

bool has_area(std::span<const Vec3f> corners) {
    if (corners.size() < 3) return false;
    double longest = 0;
    for (size_t k = 0; k < corners.size(); ++k) {
        const Vec3f &a = corners[k], &b = corners[(k + 1) % corners.size()];
        const Vec3<double> edge{double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
        longest = std::max(longest, dot(edge, edge));
    }
    const Vec3<double> normal = compute_newell_normal(corners);
    return std::sqrt(dot(normal, normal)) > kSmallestAreaRatio * longest;
}

DegenerateFaces find_degenerate_faces(const Mesh& mesh) {
    DegenerateFaces result;
    std::vector<Vec3f> corners;
    size_t start = 0;
    for (uint32_t face = 0; face < mesh.face_sizes.size(); start += mesh.face_sizes[face], ++face) {
        corners.clear();
        const uint32_t size = mesh.face_sizes[face];
        for (uint32_t k = 0; k < size; ++k) {
            const Vec3f& p = mesh.positions[mesh.position_indices[start + k]];
            if (p != mesh.positions[mesh.position_indices[start + (k + size - 1) % size]])
                corners.push_back(p);
        }
        if (!has_area(corners) && result.count++ == 0) result.first = face;
    }
    return result;
}

void drop_degenerate_faces(Polygons& polygons) {
    const std::vector<uint8_t> is_dropped = mark_degenerate(polygons);
    const auto first = std::find(is_dropped.begin(), is_dropped.end(), 1);
    if (first == is_dropped.end()) return;
    if (std::find(is_dropped.begin(), is_dropped.end(), 0) == is_dropped.end())
        throw Error(ErrorKind::bad_input,
                    {"face has zero area",
                     fmt::format("{}, face {}", polygons.where,
                                 polygons.source_faces[size_t(first - is_dropped.begin())]),
                     "remove degenerate faces from the mesh: no other is left"});
    Splicer splicer(polygons, is_dropped);
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        if (is_dropped[face]) splicer.splice(face);
    Polygons kept;
    for (const CornerUvs& set : polygons.further_uvs) kept.further_uvs.push_back({set.number, {}});
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        if (is_dropped[face]) continue;
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        begin_face(polygons, face, kept);
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t next = start + (k + 1) % size;
            add_corner(polygons, start + k, kept);
            for (const PointOnWay& point : splicer.find(start + k))
                add_corner_between(polygons, start + k, next, point, kept);
        }
    }
    kept.starts.push_back(uint32_t(kept.points.size()));
    kept.where = std::move(polygons.where), kept.positions = std::move(polygons.positions);
    kept.creases = std::move(polygons.creases);
    polygons = std::move(kept);
}

} // namespace relief
