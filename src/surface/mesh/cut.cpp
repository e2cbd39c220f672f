// Ear clipping (Meisters 1975, Polygons have ears) for all but triangles and convex quads.
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "surface/mesh/large_polygon.h"
#include "surface/mesh/polygons.h"

namespace relief {

namespace {

constexpr uint32_t kManyCorners = 256; ///< from here on the cubic time of the plain search shows

/// Corners of a face in its plane; counter-clockwise.
std::vector<Vec2<double>> project_face(const Polygons& polygons, uint32_t face) {
    const Vec3<double> n = compute_newell_normal(polygons, face);
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const double sign = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    std::vector<Vec2<double>> result;
    for (uint32_t k = polygons.starts[face]; k < polygons.starts[face + 1]; ++k) {
        const Vec3f& p = polygons.positions[polygons.points[k]];
        Vec2<double> q = axis == 0   ? Vec2<double>{p.y, p.z}
                         : axis == 1 ? Vec2<double>{p.z, p.x}
                                     : Vec2<double>{p.x, p.y};
        if (sign < 0) std::swap(q.x, q.y);
        result.push_back(q);
    }
    return result;
}

bool is_convex(const std::vector<Vec2<double>>& polygon) {
    const size_t size = polygon.size();
    for (size_t k = 0; k < size; ++k)
        if (compute_turn(polygon[k], polygon[(k + 1) % size], polygon[(k + 2) % size]) < 0) return false;
    return true;
}

bool is_ear(const std::vector<Vec2<double>>& polygon, const std::vector<uint32_t>& rest, size_t k) {
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
std::vector<std::array<uint32_t, 3>> clip_ears(const std::vector<Vec2<double>>& polygon) {
    std::vector<uint32_t> rest(polygon.size());
    for (uint32_t k = 0; k < rest.size(); ++k) rest[k] = k;
    std::vector<std::array<uint32_t, 3>> triangles;
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

} // namespace

Polygons cut_to_triangles(const Polygons& polygons) {
    Polygons result;
    result.where = polygons.where;
    result.positions = polygons.positions;
    for (const CornerUvs& set : polygons.further_uvs) result.further_uvs.push_back({set.number, {}});
    const auto add_corner = [&](uint32_t corner) {
        result.points.push_back(polygons.points[corner]);
        if (!polygons.uvs.empty()) result.uvs.push_back(polygons.uvs[corner]);
        for (size_t n = 0; n < polygons.further_uvs.size(); ++n)
            result.further_uvs[n].uvs.push_back(polygons.further_uvs[n].uvs[corner]);
        if (!polygons.normals.empty()) result.normals.push_back(polygons.normals[corner]);
    };
    const auto begin_face = [&](uint32_t face) {
        result.starts.push_back(uint32_t(result.points.size()));
        result.source_faces.push_back(polygons.source_faces[face]);
    };
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        const std::vector<Vec2<double>> outline =
            size == 3 ? std::vector<Vec2<double>>{} : project_face(polygons, face);
        if (size == 3 || (size == 4 && is_convex(outline))) {
            begin_face(face);
            for (uint32_t k = 0; k < size; ++k) add_corner(start + k);
            continue;
        }
        for (const auto& triangle :
             size < kManyCorners ? clip_ears(outline) : cut_large_polygon(outline).triangles) {
            begin_face(face);
            for (const uint32_t k : triangle) add_corner(start + k);
        }
    }
    result.starts.push_back(uint32_t(result.points.size()));
    return result;
}

} // namespace relief
