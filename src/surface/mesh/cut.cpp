// Ear clipping (Meisters 1975, Polygons have ears) of faces that cannot stay whole.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "math/vec_double.h"
#include "surface/mesh/large_polygon.h"
#include "surface/mesh/polygons.h"

namespace relief {

namespace {

using Outline = std::vector<Vec2<double>>;
using Triangle = std::array<uint32_t, 3>;

constexpr uint32_t kManyCorners = 256; ///< from here on the cubic time of the plain search shows
/// Sine of the turn to the right that corners on one line may have: no area that counts.
constexpr double kStraight = 1e-6;
constexpr double kRounding = 0x1p-22; ///< of coordinates, relative to the largest one

/// Corners of a face in its mean plane, seen along an axis; counter-clockwise.
Outline project_face(const Polygons& polygons, uint32_t face) {
    const Vec3<double> n = compute_newell_normal(polygons, face);
    const Vec3f& origin = polygons.positions[polygons.points[polygons.starts[face]]];
    const double square = dot(n, n);
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const double sign = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    Outline result;
    for (uint32_t k = polygons.starts[face]; k < polygons.starts[face + 1]; ++k) {
        const Vec3d corner = to_double(polygons.positions[polygons.points[k]]);
        const Vec3d p = corner - n * (dot(n, corner - to_double(origin)) / square);
        Vec2<double> q = axis == 0   ? Vec2<double>{p.y, p.z}
                         : axis == 1 ? Vec2<double>{p.z, p.x}
                                     : Vec2<double>{p.x, p.y};
        if (sign < 0) std::swap(q.x, q.y);
        result.push_back(q);
    }
    return result;
}

/// False where the outline turns right, or goes around more than once.
bool is_convex(const Outline& polygon) {
    const size_t size = polygon.size();
    double largest = 0;
    for (const Vec2<double>& p : polygon) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
    const auto turns_right = [&](size_t i, size_t j, size_t k) {
        const Vec2<double>&a = polygon[i], &b = polygon[j], &c = polygon[k];
        const double ab = std::hypot(b.x - a.x, b.y - a.y), bc = std::hypot(c.x - b.x, c.y - b.y);
        return compute_turn(a, b, c) < -(kStraight * ab * bc + kRounding * largest * (ab + bc));
    };
    for (size_t k = 0; k < size; ++k)
        if (turns_right(k, (k + 1) % size, (k + 2) % size)) return false;
    for (size_t k = 1; k + 1 < size; ++k)
        if (turns_right(0, k, k + 1)) return false;
    return true;
}

bool is_ear(const Outline& polygon, const std::vector<uint32_t>& rest, size_t k) {
    const size_t size = rest.size();
    const uint32_t ia = rest[(k + size - 1) % size], ib = rest[k], ic = rest[(k + 1) % size];
    const Vec2<double>&a = polygon[ia], &b = polygon[ib], &c = polygon[ic];
    if (!(compute_turn(a, b, c) > 0)) return false;
    for (const uint32_t other : rest) {
        const Vec2<double>& p = polygon[other];
        if (p == a || p == b || p == c) continue;
        if (compute_turn(a, b, p) >= 0 && compute_turn(b, c, p) >= 0 && compute_turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

/// Triangles as corners. A polygon that crosses itself may have no ear left: then any corner is taken.
std::vector<Triangle> clip_ears(const Outline& polygon) {
    std::vector<uint32_t> rest(polygon.size());
    for (uint32_t k = 0; k < rest.size(); ++k) rest[k] = k;
    std::vector<Triangle> triangles;
    while (rest.size() > 3) {
        size_t ear = 0;
        while (ear < rest.size() && !is_ear(polygon, rest, ear)) ++ear;
        if (ear == rest.size()) ear = 1;
        const size_t size = rest.size();
        triangles.push_back({rest[(ear + size - 1) % size], rest[ear], rest[(ear + 1) % size]});
        rest.erase(rest.begin() + std::ptrdiff_t(ear));
    }
    triangles.push_back({rest[0], rest[1], rest[2]});
    return triangles;
}

std::vector<Triangle> cut_outline(const Outline& outline) {
    return outline.size() < kManyCorners ? clip_ears(outline) : cut_large_polygon(outline).triangles;
}

/// An empty list of faces between the points of `polygons`.
Polygons begin_faces(const Polygons& polygons) {
    Polygons result;
    result.where = polygons.where;
    result.positions = polygons.positions;
    result.creases = polygons.creases;
    for (const CornerUvs& set : polygons.further_uvs) result.further_uvs.push_back({set.number, {}});
    return result;
}

void keep_face(const Polygons& from, uint32_t face, Polygons& to) {
    begin_face(from, face, to);
    for (uint32_t corner = from.starts[face]; corner < from.starts[face + 1]; ++corner)
        add_corner(from, corner, to);
}

/// Triangles of the concave faces of a mesh, and how often their sides inside of faces join the same points.
class ConcaveFaces {
  public:
    explicit ConcaveFaces(const Polygons& polygons) : polygons_(polygons) {
        for (uint32_t face = 0; face < polygons.face_count(); ++face) {
            if (polygons.face_size(face) == 3) continue;
            const Outline outline = project_face(polygons, face);
            if (!is_convex(outline)) triangles_.emplace(face, cut_outline(outline));
        }
        for (const auto& [face, triangles] : triangles_)
            for (const Triangle& triangle : triangles)
                for (size_t k = 0; k < 3; ++k)
                    // Each cut is a side of two triangles, once in each direction.
                    if (is_cut(face, triangle, k) && triangle[k] < triangle[(k + 1) % 3])
                        ++uses_[get_key(face, triangle[k], triangle[(k + 1) % 3])];
        if (uses_.empty()) return;
        for (uint32_t face = 0; face < polygons.face_count(); ++face)
            for (uint32_t k = 0; k < polygons.face_size(face); ++k)
                if (const auto use = uses_.find(get_key(face, k, (k + 1) % polygons.face_size(face)));
                    use != uses_.end())
                    ++use->second;
    }

    bool empty() const { return triangles_.empty(); }
    const std::vector<Triangle>* find(uint32_t face) const {
        const auto found = triangles_.find(face);
        return found == triangles_.end() ? nullptr : &found->second;
    }
    /// Whether side k of a triangle is no edge of the face.
    bool is_cut(uint32_t face, const Triangle& triangle, size_t k) const {
        const uint32_t a = triangle[k], b = triangle[(k + 1) % 3], size = polygons_.face_size(face);
        return (a + 1) % size != b && (b + 1) % size != a;
    }
    /// Whether another edge or cut joins the points of a cut.
    bool is_shared(uint32_t face, uint32_t a, uint32_t b) const { return uses_.at(get_key(face, a, b)) > 1; }

  private:
    uint64_t get_key(uint32_t face, uint32_t a, uint32_t b) const {
        const uint64_t first = polygons_.points[polygons_.starts[face] + a],
                       second = polygons_.points[polygons_.starts[face] + b];
        return std::min(first, second) << 32 | std::max(first, second);
    }

    const Polygons& polygons_;
    std::unordered_map<uint32_t, std::vector<Triangle>> triangles_; ///< by face
    std::unordered_map<uint64_t, uint32_t> uses_;                   ///< of the points of each cut
};

/// Adds the triangles of a concave face; those with two corners at one point are left out. The two of a quad
/// are quads with a corner in the middle of the cut, so that a mesh of quads stays one.
void add_triangles(const Polygons& polygons, uint32_t face, const ConcaveFaces& concave, Polygons& result) {
    const uint32_t start = polygons.starts[face];
    const bool is_quad = polygons.face_size(face) == 4;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto find_middle = [&](uint32_t a, uint32_t b) {
        const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), kNoIndex);
        if (is_new) {
            place->second = uint32_t(result.positions.size());
            result.positions.push_back((polygons.positions[polygons.points[start + a]] +
                                        polygons.positions[polygons.points[start + b]]) *
                                       0.5f);
        }
        return place->second;
    };
    for (const Triangle& triangle : *concave.find(face)) {
        const auto point = [&](size_t k) { return polygons.points[start + triangle[k % 3]]; };
        if (point(0) == point(1) || point(1) == point(2) || point(2) == point(0)) continue;
        begin_face(polygons, face, result);
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
            add_corner(polygons, start + a, result);
            if (concave.is_cut(face, triangle, k) && (is_quad || concave.is_shared(face, a, b)))
                add_corner_between(polygons, start + a, start + b, {find_middle(a, b), 0.5f}, result);
        }
    }
}

} // namespace

Polygons cut_to_triangles(const Polygons& polygons) {
    Polygons result = begin_faces(polygons);
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        const Outline outline = size == 3 ? Outline{} : project_face(polygons, face);
        if (size == 3 || (size == 4 && is_convex(outline))) {
            keep_face(polygons, face, result);
            continue;
        }
        for (const Triangle& triangle : cut_outline(outline)) {
            begin_face(polygons, face, result);
            for (const uint32_t k : triangle) add_corner(polygons, start + k, result);
        }
    }
    result.starts.push_back(uint32_t(result.points.size()));
    return result;
}

Polygons cut_concave_faces(Polygons polygons) {
    const ConcaveFaces concave(polygons);
    if (concave.empty()) return polygons;
    Polygons result = begin_faces(polygons);
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        if (concave.find(face))
            add_triangles(polygons, face, concave, result);
        else
            keep_face(polygons, face, result);
    result.starts.push_back(uint32_t(result.points.size()));
    return result;
}

} // namespace relief
