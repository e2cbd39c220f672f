// measure_uvs: islands, mirrored ones, tiles, overlaps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "analysis/mesh_points.h"
#include "analysis/mesh_statistics.h"
#include "math/vec.h"
#include "scene/face_uvs.h"

namespace relief {

namespace {

/// Connected sets of faces (union-find).
class FaceSets {
  public:
    explicit FaceSets(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
    uint32_t find(uint32_t face) {
        while (parents_[face] != face) face = parents_[face] = parents_[parents_[face]];
        return face;
    }
    void join(uint32_t a, uint32_t b) { parents_[find(a)] = find(b); }

  private:
    std::vector<uint32_t> parents_;
};

/// Cells of unit squares of the uv plane, each with the number of faces over its middle.
class Coverage {
  public:
    /// `side`: cells a unit.
    explicit Coverage(int side) : side_(side) {}
    void add(const Vec2f& a, const Vec2f& b, const Vec2f& c);
    double measure_overlap() const;

  private:
    static constexpr size_t kSquares = 256; ///< at most

    int64_t find_square(int64_t cell) const {
        return cell >= 0 ? cell / side_ : -((-cell + side_ - 1) / side_);
    }
    void count(int64_t x, int64_t y) {
        const std::pair<int64_t, int64_t> square{find_square(x), find_square(y)};
        auto found = squares_.find(square);
        if (found == squares_.end()) {
            if (squares_.size() == kSquares) return;
            found = squares_.emplace(square, std::vector<uint8_t>(size_t(side_) * size_t(side_))).first;
        }
        const int64_t column = x - square.first * side_, row = y - square.second * side_;
        uint8_t& cell = found->second[size_t(row * side_ + column)];
        if (cell < 255) ++cell;
    }

    int side_;
    std::map<std::pair<int64_t, int64_t>, std::vector<uint8_t>> squares_;
};

constexpr double kMostCells = 1 << 24; ///< about: bounds the time of large meshes

struct UvBox {
    Vec2f low, high;
    double area() const { return double(high.x - low.x) * double(high.y - low.y); }
    /// Farther out, or larger, nothing is counted.
    bool is_countable() const {
        constexpr float kLargest = 8, kFarthest = 1e6f;
        return high.x - low.x <= kLargest && high.y - low.y <= kLargest && low.x >= -kFarthest &&
               low.y >= -kFarthest && high.x <= kFarthest && high.y <= kFarthest;
    }
};

UvBox make_uv_box(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
}

/// Counts a middle on an edge for one of the two triangles beside it only.
bool is_inside(double ax, double ay, double bx, double by, double x, double y) {
    const double side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    return side > 0 || (side == 0 && (by > ay || (by == ay && bx < ax)));
}

void Coverage::add(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const UvBox box = make_uv_box(a, b, c);
    if (!box.is_countable()) return;
    const double side = side_;
    std::array<std::array<double, 2>, 3> p = {
        {{a.x * side, a.y * side}, {b.x * side, b.y * side}, {c.x * side, c.y * side}}};
    const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    if (area < 0) std::swap(p[1], p[2]);
    for (auto y = int64_t(std::floor(box.low.y * side)); double(y) <= box.high.y * side; ++y)
        for (auto x = int64_t(std::floor(box.low.x * side)); double(x) <= box.high.x * side; ++x) {
            const double mx = double(x) + 0.5, my = double(y) + 0.5;
            if (is_inside(p[0][0], p[0][1], p[1][0], p[1][1], mx, my) &&
                is_inside(p[1][0], p[1][1], p[2][0], p[2][1], mx, my) &&
                is_inside(p[2][0], p[2][1], p[0][0], p[0][1], mx, my))
                count(x, y);
        }
}

double Coverage::measure_overlap() const {
    uint64_t covered = 0, shared = 0;
    for (const auto& [square, cells] : squares_)
        for (const uint8_t cell : cells) covered += cell > 0, shared += cell > 1;
    return covered > 0 ? double(shared) / double(covered) : 0;
}

void note_place(const Mesh& mesh, size_t first, uint32_t size, MeshUvs& result) {
    Vec2f low = mesh.uvs[mesh.uv_indices[first]], high = low;
    for (uint32_t k = 0; k < size; ++k) {
        const Vec2f& uv = mesh.uvs[mesh.uv_indices[first + k]];
        low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
        high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
    }
    result.low = {std::min(result.low.x, low.x), std::min(result.low.y, low.y)};
    result.high = {std::max(result.high.x, high.x), std::max(result.high.y, high.y)};
}

/// Calls `visit` with the corners of triangles that make up the faces.
template <class Visit> void visit_uv_triangles(const Mesh& mesh, const Visit& visit) {
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const auto uv = [&](uint32_t k) { return mesh.uvs[mesh.uv_indices[first + k]]; };
        for (uint32_t k = 2; k < size; ++k) visit(uv(0), uv(k - 1), uv(k));
        first += size;
    }
}

/// Faces that share an edge with both uvs and lie the same way round are of one island.
FaceSets join_islands(const Mesh& mesh, const std::vector<double>& areas) {
    const std::vector<uint32_t> points = number_uv_points(mesh);
    FaceSets sets(mesh.face_sizes.size());
    std::unordered_map<uint64_t, uint32_t> face_of_edge;
    size_t first = 0;
    for (uint32_t face = 0; face < mesh.face_sizes.size(); ++face) {
        const uint32_t size = mesh.face_sizes[face];
        for (uint32_t k = 0; k < size; ++k) {
            const uint64_t a = points[first + k], b = points[first + (k + 1) % size];
            const auto [place, is_new] =
                face_of_edge.try_emplace(std::min(a, b) << 32 | std::max(a, b), face);
            if (is_new) continue;
            if ((areas[face] < 0) == (areas[place->second] < 0)) sets.join(face, place->second);
        }
        first += size;
    }
    return sets;
}

} // namespace

double measure_uv_overlap(const Mesh& mesh, double most_cells) {
    constexpr double kFinest = 512, kCoarsest = 4;
    double area = 0;
    visit_uv_triangles(mesh, [&](const Vec2f& a, const Vec2f& b, const Vec2f& c) {
        const UvBox box = make_uv_box(a, b, c);
        if (box.is_countable()) area += box.area();
    });
    const double side =
        area > 0 ? std::clamp(std::floor(std::sqrt(most_cells / area)), kCoarsest, kFinest) : kFinest;
    Coverage coverage{int(side)};
    visit_uv_triangles(mesh, [&](const Vec2f& a, const Vec2f& b, const Vec2f& c) { coverage.add(a, b, c); });
    return coverage.measure_overlap();
}

MeshUvs measure_uvs(const Mesh& mesh) {
    MeshUvs result;
    if (find_faces_without_uvs(mesh).count > 0) {
        result = measure_uvs(drop_faces_without_uvs(mesh));
        result.tile_use = find_tile_use(mesh); // by the numbers of this mesh's faces
        return result;
    }
    result.tile_use = find_tile_use(mesh);
    result.low = result.high = mesh.uvs[mesh.uv_indices.front()];
    std::vector<double> areas;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        areas.push_back(compute_uv_area(mesh, first, size));
        result.mirrored_faces += areas.back() < 0;
        result.flat_faces += areas.back() == 0;
        note_place(mesh, first, size, result);
        first += size;
    }
    FaceSets sets = join_islands(mesh, areas);
    std::map<uint32_t, double> area_of_island;
    for (uint32_t face = 0; face < areas.size(); ++face) area_of_island[sets.find(face)] += areas[face];
    result.islands = area_of_island.size();
    for (const auto& [island, area] : area_of_island) result.mirrored_islands += area < 0;
    result.overlap = measure_uv_overlap(mesh, kMostCells);
    return result;
}

} // namespace relief
