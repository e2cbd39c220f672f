#include "surface/mesh/degenerate_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "math/vec.h"
#include "relief/error.h"
#include "surface/mesh/join_points.h"

namespace relief {

namespace {

/// Areas below this part of the square of the longest edge are rounding of collinear corners.
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

/// Corners of polygons, to which others are added between two of them.
class CornerList {
  public:
    explicit CornerList(Polygons& polygons) : polygons_(polygons) {
        for (uint32_t face = 0; face < polygons.face_count(); ++face) {
            const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
            for (uint32_t k = 0; k < size; ++k)
                next_.push_back(start + (k + 1) % size), faces_.push_back(face);
            sizes_.push_back(size);
        }
    }

    uint32_t next(uint32_t corner) const { return next_[corner]; }
    uint32_t face(uint32_t corner) const { return faces_[corner]; }
    uint32_t size(uint32_t face) const { return sizes_[face]; }
    uint32_t count() const { return uint32_t(next_.size()); }

    /// Puts a point between `before` and `after`, the corner behind it, with attributes at `part` of the way
    /// from corner `begin` to corner `end`. Returns the new corner.
    uint32_t insert(uint32_t before, uint32_t point, uint32_t begin, uint32_t end, float part) {
        add_corner_between(polygons_, begin, end, {point, part}, polygons_);
        const auto corner = uint32_t(next_.size());
        next_.push_back(next_[before]), next_[before] = corner;
        faces_.push_back(faces_[before]);
        ++sizes_[faces_[before]];
        return corner;
    }

  private:
    Polygons& polygons_;
    std::vector<uint32_t> next_, faces_; ///< by corner
    std::vector<uint32_t> sizes_;        ///< by face
};

/// Gives the corners of faces without area to the neighbours across their longest edges. Where the neighbour
/// is such a face too, it goes first, so that each corner is given away once.
class Splicer {
  public:
    Splicer(Polygons& polygons, const std::vector<uint8_t>& is_dropped)
        : polygons_(polygons), numbers_(find_equal_points(polygons.positions)), corners_(polygons) {
        for (uint32_t corner = 0; corner < corners_.count(); ++corner)
            if (!is_dropped[corners_.face(corner)]) corner_of_edge_.try_emplace(get_edge(corner), corner);
        for (uint32_t face = 0; face < is_dropped.size(); ++face)
            if (is_dropped[face] && corners_.size(face) >= 3) {
                const auto [end, begin] = get_edge(find_longest(face));
                waiting_.try_emplace({begin, end}, face);
            }
    }

    void splice() {
        std::vector<Edge> open;
        for (const auto& [edge, face] : waiting_)
            if (corner_of_edge_.contains(edge)) open.push_back(edge);
        while (!open.empty()) {
            const auto place = waiting_.find(open.back());
            open.pop_back();
            if (place == waiting_.end()) continue;
            const auto [edge, face] = *place;
            waiting_.erase(place);
            splice(face, edge, open);
        }
    }

    const CornerList& corners() const { return corners_; }

  private:
    /// Adds the corners of a face to the one that has `edge`, and the edges that this one gets to `added`.
    /// The face stays apart where its corners have no order along the edge.
    void splice(uint32_t face, const Edge& edge, std::vector<Edge>& added) {
        const uint32_t longest = find_longest(face);
        const uint32_t from = corner_of_edge_.at(edge), to = corners_.next(from);
        const double whole = get_length(longest);
        double reached = 0;
        std::vector<std::pair<uint32_t, float>> points;
        for (uint32_t corner = corners_.next(longest); corners_.next(corner) != longest;) {
            reached += get_length(corner);
            if (!(reached < whole)) return; // the corners turn back
            corner = corners_.next(corner);
            points.emplace_back(polygons_.points[corner], float(reached / whole));
        }
        corner_of_edge_.erase(edge);
        uint32_t last = from;
        for (const auto& [point, part] : points) {
            const uint32_t corner = corners_.insert(last, point, from, to, part);
            note_edge(last, added);
            last = corner;
        }
        note_edge(last, added);
    }

    void note_edge(uint32_t corner, std::vector<Edge>& added) {
        const Edge edge = get_edge(corner);
        corner_of_edge_[edge] = corner;
        added.push_back(edge);
    }

    uint32_t find_longest(uint32_t face) const {
        const uint32_t start = polygons_.starts[face];
        uint32_t longest = start;
        for (uint32_t corner = corners_.next(start); corner != start; corner = corners_.next(corner))
            if (get_length(corner) > get_length(longest)) longest = corner;
        return longest;
    }
    Edge get_edge(uint32_t corner) const {
        return {numbers_[polygons_.points[corner]], numbers_[polygons_.points[corners_.next(corner)]]};
    }
    double get_length(uint32_t corner) const {
        return length(polygons_.positions[polygons_.points[corners_.next(corner)]] -
                      polygons_.positions[polygons_.points[corner]]);
    }

    Polygons& polygons_;
    std::vector<uint32_t> numbers_;
    CornerList corners_;
    std::map<Edge, uint32_t>
        corner_of_edge_;               ///< of faces that stay; by its two points in the order of the face
    std::map<Edge, uint32_t> waiting_; ///< faces without area, by the edge that a neighbour would have
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
    splicer.splice();
    const CornerList& corners = splicer.corners();
    Polygons kept;
    for (const CornerUvs& set : polygons.further_uvs) kept.further_uvs.push_back({set.number, {}});
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        if (is_dropped[face]) continue;
        begin_face(polygons, face, kept);
        const uint32_t start = polygons.starts[face];
        uint32_t corner = start;
        do add_corner(polygons, corner, kept), corner = corners.next(corner);
        while (corner != start);
    }
    kept.starts.push_back(uint32_t(kept.points.size()));
    kept.where = std::move(polygons.where), kept.positions = std::move(polygons.positions);
    kept.creases = std::move(polygons.creases);
    polygons = std::move(kept);
}

} // namespace relief
