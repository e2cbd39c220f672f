#include "lab/scenes/box_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "math/vec.h"

namespace relief {

namespace {

/// Directions of a side of a box: u x v points outwards.
struct SideFrame {
    int u_axis, v_axis, normal_axis;
    bool is_u_reversed, is_high; ///< u runs down; the side lies at the high end of normal_axis
};

SideFrame find_frame(const LatticeBox& box, int side) {
    const int a = box.axis, b = (a + 1) % 3, c = (a + 2) % 3;
    const SideFrame frames[kBoxSides] = {{b, a, c, false, false}, {c, a, b, false, true},
                                         {b, a, c, true, true},   {c, a, b, true, false},
                                         {c, b, a, false, false}, {b, c, a, false, true}};
    return frames[side];
}

bool contains(const LatticeBox& box, const std::array<float, 3>& p) {
    for (size_t k = 0; k < 3; ++k)
        if (p[k] < float(box.low[k]) || p[k] > float(box.high[k])) return false;
    return true;
}

class BoxMesher {
  public:
    BoxMesher(const std::vector<LatticeBox>& boxes, int cells) : boxes_(boxes), cells_(cells) {}

    void add(const LatticeBox& box, int side, const UvRectangle& uv) {
        const auto [across, along] = find_side_size(box, side);
        BoxSide grid{across * cells_, along * cells_, uv, {}};
        grid.points.assign(size_t(grid.across + 1) * size_t(grid.along + 1), kNoIndex);
        const SideFrame frame = find_frame(box, side);
        for (int j = 0; j < grid.along; ++j)
            for (int i = 0; i < grid.across; ++i)
                if (!is_covered(box, frame, i, j)) add_quad(box, frame, grid, i, j);
        result_.sides.push_back(std::move(grid));
    }

    /// Where boxes touch, points of one on the edge of what it covers of another belong to both.
    BoxMesh finish() {
        for (size_t k = 0; k < result_.sides.size(); ++k) {
            BoxSide& grid = result_.sides[k];
            const LatticeBox& box = boxes_[k / kBoxSides];
            const SideFrame frame = find_frame(box, int(k % kBoxSides));
            for (size_t p = 0; p < grid.points.size(); ++p) {
                const int row = grid.across + 1;
                const auto found = positions_.find(find_place(box, frame, int(p) % row, int(p) / row));
                if (found != positions_.end()) grid.points[p] = found->second;
            }
        }
        return std::move(result_);
    }

  private:
    /// In cells; `along_u` and `along_v` may lie between lattice points.
    template <class T>
    std::array<T, 3> find_place(const LatticeBox& box, const SideFrame& frame, T along_u, T along_v) const {
        const auto low = [&](int axis) { return T(box.low[size_t(axis)] * cells_); };
        const auto high = [&](int axis) { return T(box.high[size_t(axis)] * cells_); };
        std::array<T, 3> place{};
        const int u = frame.u_axis, n = frame.normal_axis;
        place[size_t(u)] = frame.is_u_reversed ? high(u) - along_u : low(u) + along_u;
        place[size_t(frame.v_axis)] = low(frame.v_axis) + along_v;
        place[size_t(n)] = frame.is_high ? high(n) : low(n);
        return place;
    }

    /// Whether another box lies outside of the quad.
    bool is_covered(const LatticeBox& box, const SideFrame& frame, int i, int j) const {
        std::array<float, 3> p = find_place(box, frame, float(i) + 0.5f, float(j) + 0.5f);
        for (float& x : p) x /= float(cells_);
        p[size_t(frame.normal_axis)] += frame.is_high ? 0.5f : -0.5f;
        return std::ranges::any_of(boxes_, [&](const LatticeBox& other) { return contains(other, p); });
    }

    void add_quad(const LatticeBox& box, const SideFrame& frame, const BoxSide& grid, int i, int j) {
        Mesh& mesh = result_.mesh;
        for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            const int a = i + di, b = j + dj;
            const uint32_t position = add_position(find_place(box, frame, a, b));
            mesh.position_indices.push_back(position);
            const UvRectangle& r = grid.uv;
            mesh.uv_indices.push_back(
                add_uv(position, {r.low.x + r.size.x * (float(a) / float(grid.across)),
                                  r.low.y + r.size.y * (float(b) / float(grid.along))}));
        }
        mesh.face_sizes.push_back(4);
    }

    uint32_t add_position(const LatticePoint& place) {
        const auto [found, is_new] = positions_.emplace(place, uint32_t(result_.lattice.size()));
        if (is_new) {
            const float scale = 1 / float(cells_);
            result_.lattice.push_back(place);
            result_.mesh.positions.push_back(Vec3f{float(place[0]), float(place[1]), float(place[2])} *
                                             scale);
        }
        return found->second;
    }

    uint32_t add_uv(uint32_t position, const Vec2f& uv) {
        const auto [found, is_new] =
            uvs_.emplace(std::tuple(position, uv.x, uv.y), uint32_t(result_.mesh.uvs.size()));
        if (is_new) result_.mesh.uvs.push_back(uv);
        return found->second;
    }

    const std::vector<LatticeBox>& boxes_;
    int cells_;
    BoxMesh result_;
    std::map<LatticePoint, uint32_t> positions_;
    std::map<std::tuple<uint32_t, float, float>, uint32_t> uvs_;
};

/// Each edge once, by its smaller index first.
std::set<std::pair<uint32_t, uint32_t>> list_edges(const Mesh& mesh) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner) {
        const size_t next = corner % 4 == 3 ? corner - 3 : corner + 1;
        edges.insert(std::minmax(mesh.position_indices[corner], mesh.position_indices[next]));
    }
    return edges;
}

std::vector<Vec3f> compute_normals(const Mesh& mesh) {
    std::vector<Vec3f> normals(mesh.positions.size());
    for (size_t first = 0; first < mesh.position_indices.size(); first += 4) {
        const auto at = [&](size_t k) { return mesh.positions[mesh.position_indices[first + k]]; };
        const Vec3f normal = cross(at(2) - at(0), at(3) - at(1));
        for (size_t k = 0; k < 4; ++k) normals[mesh.position_indices[first + k]] += normal;
    }
    for (Vec3f& normal : normals) normal = normalize(normal);
    return normals;
}

/// Distance of a point from a rectangle along the axis where it is larger.
float find_distance(const UvRectangle& r, const Vec2f& uv) {
    const float x = std::max(r.low.x - uv.x, uv.x - (r.low.x + r.size.x));
    const float y = std::max(r.low.y - uv.y, uv.y - (r.low.y + r.size.y));
    return std::max({x, y, 0.0f});
}

} // namespace

std::array<int, 2> find_side_size(const LatticeBox& box, int side) {
    const SideFrame frame = find_frame(box, side);
    const auto size = [&](int axis) { return box.high[size_t(axis)] - box.low[size_t(axis)]; };
    return {size(frame.u_axis), size(frame.v_axis)};
}

BoxMesh make_box_mesh(const std::vector<LatticeBox>& boxes, int cells,
                      const std::function<UvRectangle(size_t box, int side)>& place) {
    BoxMesher mesher(boxes, cells);
    for (size_t box = 0; box < boxes.size(); ++box)
        for (int side = 0; side < kBoxSides; ++side) mesher.add(boxes[box], side, place(box, side));
    return mesher.finish();
}

void smooth_positions(Mesh& mesh, int rounds) {
    const auto edges = list_edges(mesh);
    std::vector<Vec3f> sums(mesh.positions.size());
    std::vector<float> counts(mesh.positions.size());
    for (int round = 0; round < rounds; ++round) {
        std::ranges::fill(sums, Vec3f{});
        std::ranges::fill(counts, 0.0f);
        for (const auto& [a, b] : edges) {
            sums[a] += mesh.positions[b], sums[b] += mesh.positions[a];
            ++counts[a], ++counts[b];
        }
        for (size_t k = 0; k < sums.size(); ++k)
            mesh.positions[k] = (mesh.positions[k] + sums[k] / counts[k]) * 0.5f;
    }
}

void add_crease_loop(BoxMesh& body, int axis, int value, float sharpness) {
    const auto lies_there = [&](uint32_t position) { return body.lattice[position][size_t(axis)] == value; };
    for (const auto& [a, b] : list_edges(body.mesh))
        if (lies_there(a) && lies_there(b)) body.mesh.creases.push_back({a, b, sharpness});
}

SurfaceFinder::SurfaceFinder(const BoxMesh& body) : body_(body), normals_(compute_normals(body.mesh)) {}

SurfacePoint SurfaceFinder::find(const Vec2f& uv) const {
    const BoxSide& side =
        *std::ranges::min_element(body_.sides, {}, [&](const BoxSide& s) { return find_distance(s.uv, uv); });
    const auto locate = [](float x, float low, float size, int count) {
        return std::clamp((x - low) / size * float(count), 0.0f, float(count));
    };
    const float x = locate(uv.x, side.uv.low.x, side.uv.size.x, side.across);
    const float y = locate(uv.y, side.uv.low.y, side.uv.size.y, side.along);
    const int i = std::min(int(x), side.across - 1), j = std::min(int(y), side.along - 1);
    SurfacePoint sum;
    float total = 0;
    for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const float weight = (1 - std::fabs(x - float(i + di))) * (1 - std::fabs(y - float(j + dj)));
        const uint32_t point = side.points[size_t(j + dj) * size_t(side.across + 1) + size_t(i + di)];
        if (point == kNoIndex) continue;
        sum.position += body_.mesh.positions[point] * weight;
        sum.normal += normals_[point] * weight;
        total += weight;
    }
    if (!(total > 0)) return {};
    return {sum.position / total, normalize(sum.normal)};
}

} // namespace relief
