#include "surface/isolate.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

constexpr uint32_t kNoCorner = 4;

class Isolation {
  public:
    Isolation(const RefinedMesh& source, int depth) : source_(source), depth_(uint32_t(depth)) {
        result_.point_count = source.point_count;
        result_.is_regular = source.is_regular;
        result_.limit_normals = source.limit_normals;
        result_.is_sharp = source.is_sharp;
        first_of_edge_.assign(source.is_sharp.size(), kNoIndex);
    }

    RefinedMesh run() {
        const std::vector<bool> is_cut = find_points();
        for (uint32_t quad = 0; quad < source_.quad_count(); ++quad) {
            const uint32_t corner = find_irregular_corner(quad);
            if (corner != kNoCorner && is_cut[source_.points[quad][corner]])
                cut(quad, corner);
            else
                add_quad(quad, source_.points[quad], source_.edges[quad], {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
                         0);
        }
        result_.first_quads.assign(result_.is_sharp.size(), kNoIndex);
        for (uint32_t quad = result_.quad_count(); quad-- > 0;)
            for (const uint32_t edge : result_.edges[quad]) result_.first_quads[edge] = quad;
        return std::move(result_);
    }

  private:
    using Corners = std::array<Vec2<double>, 4>;

    /// The one corner that is irregular; kNoCorner: none, or more.
    uint32_t find_irregular_corner(uint32_t quad) const {
        uint32_t found = kNoCorner, count = 0;
        for (uint32_t k = 0; k < 4; ++k)
            if (!source_.is_regular[source_.points[quad][k]]) found = k, ++count;
        return count == 1 ? found : kNoCorner;
    }

    /// Irregular points that are alone in all of their quads.
    std::vector<bool> find_points() const {
        std::vector<bool> is_cut(source_.point_count);
        for (uint32_t point = 0; point < source_.point_count; ++point)
            is_cut[point] = !source_.is_regular[point];
        for (uint32_t quad = 0; quad < source_.quad_count(); ++quad)
            if (find_irregular_corner(quad) == kNoCorner)
                for (const uint32_t point : source_.points[quad]) is_cut[point] = false;
        return is_cut;
    }

    uint32_t add_point() {
        result_.is_regular.push_back(true);
        result_.limit_normals.push_back({});
        return result_.point_count++;
    }

    uint32_t add_edge(bool is_sharp) {
        result_.is_sharp.push_back(is_sharp);
        return uint32_t(result_.is_sharp.size() - 1);
    }

    /// Points at 1/2, 1/4, ... of an edge from its irregular end, each with the edge to the one before; made
    /// by the first of the two quads.
    void cut_edge(uint32_t edge, std::vector<uint32_t>& points, std::vector<uint32_t>& edges) {
        if (first_of_edge_[edge] == kNoIndex) {
            first_of_edge_[edge] = uint32_t(cuts_.size());
            for (uint32_t d = 0; d < depth_; ++d)
                cuts_.push_back({add_point(), add_edge(source_.is_sharp[edge])});
        }
        for (uint32_t d = 0; d < depth_; ++d) {
            points.push_back(cuts_[first_of_edge_[edge] + d].point);
            edges.push_back(cuts_[first_of_edge_[edge] + d].edge);
        }
    }

    /// `corners`: in a square whose corner 0 is corner `turn` of the quad.
    void add_quad(uint32_t quad, const std::array<uint32_t, 4>& points, const std::array<uint32_t, 4>& edges,
                  const Corners& corners, uint32_t turn) {
        result_.points.push_back(points);
        result_.edges.push_back(edges);
        const QuadPlace& place = source_.places[quad];
        QuadPlace& added = result_.places.emplace_back(QuadPlace{place.face, place.part, {}});
        for (size_t k = 0; k < 4; ++k) {
            const auto [x, y] = corners[k];
            const auto blend = [&, x = x, y = y](const auto& c) {
                return (c(0) * (1 - x) + c(1) * x) * (1 - y) + (c(3) * (1 - x) + c(2) * x) * y;
            };
            added.corners[k] = blend([&](uint32_t c) { return place.corners[(c + turn) % 4]; });
            if (source_.uvs.empty()) continue;
            if (k == 0) result_.uvs.emplace_back();
            const Vec2<double> uv = blend([&](uint32_t c) {
                const Vec2f& own = source_.uvs[quad][(c + turn) % 4];
                return Vec2<double>{own.x, own.y};
            });
            result_.uvs.back()[k] = {float(uv.x), float(uv.y)};
        }
    }

    void cut(uint32_t quad, uint32_t turn) {
        const auto point = [&](uint32_t k) { return source_.points[quad][(k + turn) % 4]; };
        const auto edge = [&](uint32_t k) { return source_.edges[quad][(k + turn) % 4]; };
        // On the sides that meet at the irregular point, and on the diagonal, from far to near.
        std::vector<uint32_t> next = {point(1)}, previous = {point(3)}, middle = {point(2)}, to_next,
                              to_previous;
        cut_edge(edge(0), next, to_next);
        cut_edge(edge(3), previous, to_previous);
        std::array<uint32_t, 2> outer = {edge(1), edge(2)};
        double s = 1;
        for (uint32_t d = 1; d <= depth_; ++d, s /= 2) {
            middle.push_back(add_point());
            const std::array<uint32_t, 2> inner = {add_edge(false), add_edge(false)};
            const uint32_t diagonal = add_edge(false);
            const double h = s / 2;
            add_quad(quad, {next[d], next[d - 1], middle[d - 1], middle[d]},
                     {to_next[d - 1], outer[0], diagonal, inner[0]}, {{{h, 0}, {s, 0}, {s, s}, {h, h}}},
                     turn);
            add_quad(quad, {middle[d], middle[d - 1], previous[d - 1], previous[d]},
                     {diagonal, outer[1], to_previous[d - 1], inner[1]}, {{{h, h}, {s, s}, {0, s}, {0, h}}},
                     turn);
            outer = inner;
        }
        add_quad(quad, {point(0), next[depth_], middle[depth_], previous[depth_]},
                 {edge(0), outer[0], outer[1], edge(3)}, {{{0, 0}, {s, 0}, {s, s}, {0, s}}}, turn);
    }

    struct EdgeCut {
        uint32_t point, edge;
    };
    const RefinedMesh& source_;
    uint32_t depth_;
    RefinedMesh result_;
    std::vector<uint32_t> first_of_edge_; ///< among the cuts
    std::vector<EdgeCut> cuts_;
};

} // namespace

void isolate_irregular_points(RefinedMesh& refined, int depth) { refined = Isolation(refined, depth).run(); }

} // namespace relief
