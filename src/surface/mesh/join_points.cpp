#include "surface/mesh/join_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "math/box.h"
#include "math/vec.h"
#include "surface/mesh/open_edges.h"
#include "surface/mesh/point_sets.h"
#include "surface/mesh/polygons.h"

namespace relief {

namespace {

/// Rounding errors of a transform and of six decimals in a text, relative to the size of the mesh.
constexpr float kRounding = 0x1p-18f;
/// Four units in the last place of the largest coordinate.
constexpr float kUlps = 0x1p-22f;
/// Edges nearer than this part of the size of the mesh were probably meant to be one.
constexpr float kNear = 1e-5f;
/// Faces whose angle at the edge has a larger cosine lie on each other.
constexpr double kFoldedCosine = 0.9999;

float largest_coordinate(const Vec3f& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

struct PositionHash {
    size_t operator()(const Vec3f& p) const {
        uint64_t hash = std::bit_cast<uint32_t>(p.x) | uint64_t(std::bit_cast<uint32_t>(p.y)) << 32;
        hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15u + std::bit_cast<uint32_t>(p.z);
        hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9u;
        return size_t(hash ^ hash >> 32);
    }
};

/// Edges by the cell of a grid that their middle is in.
class EdgeGrid {
  public:
    explicit EdgeGrid(double cell) : cell_(cell) {}

    void add(const Vec3<double>& middle, uint32_t edge) { cells_[find_cell(middle)].push_back(edge); }

    /// Calls `visit(edge)` for all edges within half a cell. More edges than kMostInCell have no clear
    /// neighbours: those are passed over.
    template <class Visit> void visit_near(const Vec3<double>& middle, const Visit& visit) const {
        constexpr size_t kMostInCell = 64;
        const Cell cell = find_cell(middle);
        for (int64_t corner = 0; corner < 8; ++corner) {
            Cell near = cell;
            const std::array<double, 3> at{middle.x, middle.y, middle.z};
            for (size_t axis = 0; axis < 3; ++axis)
                if (corner >> axis & 1) near[axis] += at[axis] / cell_ - double(cell[axis]) < 0.5 ? -1 : 1;
            const auto found = cells_.find(near);
            if (found == cells_.end() || found->second.size() > kMostInCell) continue;
            for (const uint32_t edge : found->second) visit(edge);
        }
    }

  private:
    using Cell = std::array<int64_t, 3>;
    struct CellHash {
        size_t operator()(const Cell& cell) const {
            uint64_t hash = 0;
            for (const int64_t part : cell) {
                hash = (hash ^ uint64_t(part)) * 0x9e3779b97f4a7c15u;
                hash ^= hash >> 29;
            }
            return size_t(hash);
        }
    };
    Cell find_cell(const Vec3<double>& p) const {
        return {int64_t(std::floor(p.x / cell_)), int64_t(std::floor(p.y / cell_)),
                int64_t(std::floor(p.z / cell_))};
    }

    double cell_;
    std::unordered_map<Cell, std::vector<uint32_t>, CellHash> cells_;
};

/// Joins the open edges of a mesh that lie on each other.
class EdgeJoiner {
  public:
    EdgeJoiner(const Mesh& mesh, const std::vector<uint32_t>& equal_points, float reach)
        : mesh_(mesh), equal_points_(equal_points), reach_(reach) {
        for (const uint32_t point : mesh.position_indices) points_.push_back(equal_points[point]);
        edges_ = list_open_edges(mesh.face_sizes, points_, mesh.positions.size());
    }

    JoinedPoints join() {
        JoinedPoints result{equal_points_, 0, 0, 0};
        if (edges_.empty() || !(reach_ > 0)) return result;
        find_partners();
        PointSets sets(equal_points_);
        for (uint32_t edge = 0; edge < edges_.size(); ++edge)
            if (partners_[edge]) join_ends(edges_[edge], *partners_[edge], sets);
        apart_.assign(mesh_.positions.size(), false);
        keep_faces_apart(sets);
        for (uint32_t point = 0; point < mesh_.positions.size(); ++point) {
            const uint32_t set = sets.find(point);
            if (!apart_[set]) result.representatives[point] = set;
            if (mesh_.positions[result.representatives[point]] != mesh_.positions[point])
                ++result.moved_points;
        }
        for (uint32_t edge = 0; edge < edges_.size(); ++edge) count_joined(edge, sets, result);
        return result;
    }

  private:
    struct Partner {
        uint32_t edge;
        bool is_turned; ///< runs the other way, as neighbours with consistent normals do
        float distance; ///< larger one of both ends, along an axis
    };

    const Vec3f& position(uint32_t point) const { return mesh_.positions[point]; }
    float measure(uint32_t a, uint32_t b) const { return largest_coordinate(position(a) - position(b)); }

    static Vec3<double> to_double(const Vec3f& p) { return {double(p.x), double(p.y), double(p.z)}; }
    Vec3<double> find_middle(const OpenEdge& edge) const {
        return (to_double(position(edge.first)) + to_double(position(edge.second))) * 0.5;
    }

    Vec3<double> find_normal(uint32_t face) const {
        const uint32_t begin = starts_[face], end = begin + mesh_.face_sizes[face];
        std::vector<Vec3f> corners;
        for (uint32_t corner = begin; corner < end; ++corner) corners.push_back(position(points_[corner]));
        return compute_newell_normal(corners);
    }

    /// Unit direction from the edge into its face; zero where the face has no area.
    Vec3<double> find_inward(const OpenEdge& edge, const Vec3<double>& face_normal) const {
        const Vec3<double> along = to_double(position(edge.second)) - to_double(position(edge.first));
        const Vec3<double> inward = cross(face_normal, along);
        const double length = std::sqrt(dot(inward, inward));
        return length > 0 ? inward * (1 / length) : Vec3<double>{};
    }

    /// Edges do not lie on each other that are further apart than half of their length.
    float find_reach(const OpenEdge& edge) const {
        return std::min(reach_, measure(edge.first, edge.second) / 2);
    }

    std::optional<Partner> compare(uint32_t own, uint32_t other) const {
        const OpenEdge &a = edges_[own], &b = edges_[other];
        if (a.face == b.face) return {};
        const float turned = std::max(measure(a.first, b.second), measure(a.second, b.first));
        const float straight = std::max(measure(a.first, b.first), measure(a.second, b.second));
        const Partner partner{other, turned <= straight, std::min(turned, straight)};
        if (!(partner.distance <= std::min(find_reach(a), find_reach(b)))) return {};
        if (dot(inward_[own], inward_[other]) > kFoldedCosine) return {};
        return partner;
    }

    /// True if `a` is the better one: neighbours with consistent normals first, then the nearest.
    static bool is_better(const Partner& a, const std::optional<Partner>& b) {
        if (!b) return true;
        if (a.is_turned != b->is_turned) return a.is_turned;
        return a.distance != b->distance ? a.distance < b->distance : a.edge < b->edge;
    }

    void find_partners() {
        starts_.reserve(mesh_.face_sizes.size());
        uint32_t start = 0;
        for (const uint32_t size : mesh_.face_sizes) starts_.push_back(start), start += size;
        float largest = 0;
        for (const OpenEdge& edge : edges_)
            for (const uint32_t point : {edge.first, edge.second})
                largest = std::max(largest, largest_coordinate(position(point)));
        EdgeGrid grid(std::max(4 * double(reach_), double(largest) * 0x1p-40));
        Vec3<double> normal;
        for (uint32_t edge = 0; edge < edges_.size(); ++edge) {
            if (edge == 0 || edges_[edge].face != edges_[edge - 1].face)
                normal = find_normal(edges_[edge].face);
            inward_.push_back(find_inward(edges_[edge], normal));
            grid.add(find_middle(edges_[edge]), edge);
        }
        std::vector<std::optional<Partner>> best(edges_.size());
        for (uint32_t edge = 0; edge < edges_.size(); ++edge)
            grid.visit_near(find_middle(edges_[edge]), [&](uint32_t other) {
                const std::optional<Partner> partner = compare(edge, other);
                if (partner && is_better(*partner, best[edge])) best[edge] = partner;
            });
        // Of a double sheet each side goes with its own continuation. A third sheet joins two that are one.
        partners_.resize(edges_.size());
        for (uint32_t edge = 0; edge < edges_.size(); ++edge) {
            if (!best[edge]) continue;
            const uint32_t other = best[edge]->edge;
            const uint32_t back = best[other] ? best[other]->edge : edge;
            const bool is_pair = best[back] && best[back]->edge == other;
            if (back == edge || (is_pair && compare(edge, back))) partners_[edge] = best[edge];
        }
    }

    void join_ends(const OpenEdge& edge, const Partner& partner, PointSets& sets) const {
        const OpenEdge& other = edges_[partner.edge];
        sets.join(edge.first, partner.is_turned ? other.second : other.first);
        sets.join(edge.second, partner.is_turned ? other.first : other.second);
    }

    /// Marks sets that would join two points of a face, or reach far beyond two of their points.
    void keep_faces_apart(PointSets& sets) {
        std::unordered_map<uint32_t, Box> bounds;
        for (const OpenEdge& edge : edges_)
            for (const uint32_t point : {edge.first, edge.second})
                bounds[sets.find(point)].extend(position(point));
        for (const auto& [set, box] : bounds)
            if (largest_coordinate(box.extent()) > 4 * reach_) apart_[set] = true;
        std::vector<uint32_t> seen(mesh_.positions.size(), kNoIndex); // by set: corner of the face, if any
        for (uint32_t face = 0; face < mesh_.face_sizes.size(); ++face) {
            const uint32_t begin = starts_[face], end = begin + mesh_.face_sizes[face];
            for (uint32_t corner = begin; corner < end; ++corner) {
                const uint32_t set = sets.find(points_[corner]);
                const bool is_again = seen[set] != kNoIndex && seen[set] >= begin;
                if (is_again && points_[seen[set]] != points_[corner]) apart_[set] = true;
                seen[set] = corner;
            }
        }
    }

    void count_joined(uint32_t edge, PointSets& sets, JoinedPoints& result) const {
        const std::optional<Partner>& partner = partners_[edge];
        if (!partner || apart_[sets.find(edges_[edge].first)] || apart_[sets.find(edges_[edge].second)])
            return;
        ++result.joined_edges;
        result.farthest = std::max(result.farthest, partner->distance);
    }

    const Mesh& mesh_;
    const std::vector<uint32_t>& equal_points_;
    float reach_;
    std::vector<uint32_t> points_, starts_; ///< one per corner; first corners of faces
    std::vector<OpenEdge> edges_;
    std::vector<Vec3<double>> inward_;
    std::vector<std::optional<Partner>> partners_; ///< of the edges
    std::vector<bool> apart_;                      ///< by set
};

/// Measures of the points that faces have.
struct Measures {
    Box box;
    float largest = 0; ///< coordinate, as an absolute value
};

Measures measure_points(const Mesh& mesh) {
    Measures result;
    for (const uint32_t index : mesh.position_indices) {
        const Vec3f& p = mesh.positions[index];
        result.box.extend(p), result.largest = std::max(result.largest, largest_coordinate(p));
    }
    return result;
}

float choose_reach(const Mesh& mesh, const Measures& measures) {
    if (mesh.weld) return *mesh.weld;
    return std::max(largest_coordinate(measures.box.extent()) * kRounding, measures.largest * kUlps);
}

/// Rounded up to two digits.
float round_up(float value) {
    const double step = std::pow(10.0, std::floor(std::log10(double(value))) - 1);
    return float(std::ceil(double(value) / step) * step);
}

} // namespace

std::vector<uint32_t> find_equal_points(const std::vector<Vec3f>& positions) {
    std::unordered_map<Vec3f, uint32_t, PositionHash> first_at;
    first_at.reserve(positions.size());
    std::vector<uint32_t> result(positions.size());
    for (uint32_t k = 0; k < positions.size(); ++k)
        result[k] = first_at.try_emplace(positions[k] + Vec3f{}, k).first->second; // -0 is 0
    return result;
}

JoinedPoints join_points(const Mesh& mesh) {
    const std::vector<uint32_t> equal = find_equal_points(mesh.positions);
    if (mesh.position_indices.empty()) return {equal, 0, 0, 0};
    return EdgeJoiner(mesh, equal, choose_reach(mesh, measure_points(mesh))).join();
}

NearEdges find_near_edges(const Mesh& mesh) {
    if ((mesh.weld && *mesh.weld == 0) || mesh.position_indices.empty()) return {};
    const Measures measures = measure_points(mesh);
    const float reach = choose_reach(mesh, measures);
    const float near = std::max(kNear * length(measures.box.extent()), 4 * kUlps * measures.largest);
    if (!(near > reach)) return {};
    const std::vector<uint32_t> equal = find_equal_points(mesh.positions);
    const JoinedPoints wide = EdgeJoiner(mesh, equal, near).join();
    if (wide.joined_edges == 0) return {};
    const JoinedPoints joined = EdgeJoiner(mesh, equal, reach).join();
    if (wide.joined_edges <= joined.joined_edges) return {};
    return {wide.joined_edges - joined.joined_edges, round_up(wide.farthest)};
}

std::string describe_near_edges(const NearEdges& edges) {
    return fmt::format(
        "{} open edges are within {:g} of each other but not joined, so that a displaced "
        "surface has cracks there; mesh.weld = {:g} joins them, mesh.weld = 0 keeps them apart "
        "without this warning",
        edges.count, edges.weld, edges.weld);
}

} // namespace relief
