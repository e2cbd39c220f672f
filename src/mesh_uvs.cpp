// survey_uvs: islands, mirrored ones, tiles, overlaps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "math/vec.h"
#include "mesh_points.h"
#include "mesh_survey.h"

namespace relief {

namespace {

/// Sets of faces that hang together.
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
    void add(const Vec2f& a, const Vec2f& b, const Vec2f& c);
    double measure_overlap() const;

  private:
    static constexpr int kSide = 512;          ///< cells a unit
    static constexpr size_t kSquares = 256;    ///< so many are looked at
    static constexpr float kLargest = 8;       ///< units; a triangle that is larger is left out
    static constexpr double kBudget = 1 << 27; ///< cells looked at, so that no mesh takes long

    void count(int64_t x, int64_t y) {
        const auto floor_divide = [](int64_t value) {
            return value >= 0 ? value / kSide : -((-value + kSide - 1) / kSide);
        };
        const std::pair<int64_t, int64_t> square{floor_divide(x), floor_divide(y)};
        auto found = squares_.find(square);
        if (found == squares_.end()) {
            if (squares_.size() == kSquares) return;
            found = squares_.emplace(square, std::vector<uint8_t>(size_t(kSide) * kSide)).first;
        }
        uint8_t& cell =
            found->second[size_t(y - square.second * kSide) * kSide + size_t(x - square.first * kSide)];
        if (cell < 255) ++cell;
    }

    std::map<std::pair<int64_t, int64_t>, std::vector<uint8_t>> squares_;
    double looked_at_ = 0;
};

/// Counts a middle on an edge for one of the two triangles beside it only.
bool is_inside(double ax, double ay, double bx, double by, double x, double y) {
    const double side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    return side > 0 || (side == 0 && (by > ay || (by == ay && bx < ax)));
}

void Coverage::add(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const float low_x = std::min({a.x, b.x, c.x}), high_x = std::max({a.x, b.x, c.x});
    const float low_y = std::min({a.y, b.y, c.y}), high_y = std::max({a.y, b.y, c.y});
    constexpr float kFarthest = 1e6f;
    if (high_x - low_x > kLargest || high_y - low_y > kLargest || low_x < -kFarthest || low_y < -kFarthest ||
        high_x > kFarthest || high_y > kFarthest)
        return;
    looked_at_ += (double(high_x - low_x) * kSide + 2) * (double(high_y - low_y) * kSide + 2);
    if (looked_at_ > kBudget) return;
    std::array<std::array<double, 2>, 3> p = {{{double(a.x) * kSide, double(a.y) * kSide},
                                               {double(b.x) * kSide, double(b.y) * kSide},
                                               {double(c.x) * kSide, double(c.y) * kSide}}};
    const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    if (area < 0) std::swap(p[1], p[2]);
    for (int64_t y = int64_t(std::floor(low_y * kSide)); y <= int64_t(high_y * kSide) + 1; ++y)
        for (int64_t x = int64_t(std::floor(low_x * kSide)); x <= int64_t(high_x * kSide) + 1; ++x) {
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

double compute_area(const Mesh& mesh, size_t first, uint32_t size) {
    double area = 0;
    for (uint32_t k = 0; k < size; ++k) {
        const Vec2f& a = mesh.uvs[mesh.uv_indices[first + k]];
        const Vec2f& b = mesh.uvs[mesh.uv_indices[first + (k + 1) % size]];
        area += (double(a.x) * b.y - double(a.y) * b.x) / 2;
    }
    return area;
}

void note_place(const Mesh& mesh, size_t first, uint32_t size, MeshUvs& result) {
    double u = 0, v = 0;
    Vec2f low = mesh.uvs[mesh.uv_indices[first]], high = low;
    for (uint32_t k = 0; k < size; ++k) {
        const Vec2f& uv = mesh.uvs[mesh.uv_indices[first + k]];
        u += uv.x / size, v += uv.y / size;
        low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
        high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
    }
    result.low = {std::min(result.low.x, low.x), std::min(result.low.y, low.y)};
    result.high = {std::max(result.high.x, high.x), std::max(result.high.y, high.y)};
    const double column = std::floor(u), row = std::floor(v);
    const bool is_numbered = column >= 0 && column < 10 && row >= 0 && row < 900;
    if (is_numbered)
        result.tiles.insert(1001 + int(column) + 10 * int(row));
    else
        ++result.outside_faces;
    if (double(low.x) < column || double(high.x) > column + 1 || double(low.y) < row ||
        double(high.y) > row + 1)
        ++result.crossing_faces;
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

MeshUvs survey_uvs(const Mesh& mesh) {
    MeshUvs result;
    result.low = result.high = mesh.uvs[mesh.uv_indices.front()];
    Coverage coverage;
    std::vector<double> areas;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        areas.push_back(compute_area(mesh, first, size));
        result.mirrored_faces += areas.back() < 0;
        result.flat_faces += areas.back() == 0;
        note_place(mesh, first, size, result);
        const auto uv = [&](uint32_t k) { return mesh.uvs[mesh.uv_indices[first + k]]; };
        for (uint32_t k = 2; k < size; ++k) coverage.add(uv(0), uv(k - 1), uv(k));
        first += size;
    }
    FaceSets sets = join_islands(mesh, areas);
    std::map<uint32_t, double> area_of_island;
    for (uint32_t face = 0; face < areas.size(); ++face) area_of_island[sets.find(face)] += areas[face];
    result.islands = area_of_island.size();
    for (const auto& [island, area] : area_of_island) result.mirrored_islands += area < 0;
    result.overlap = coverage.measure_overlap();
    return result;
}

} // namespace relief
