#include "surface/mesh/limit_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {

namespace {

/// Cells of a 2048th of the face are the smallest; within them the surface is nearly flat.
constexpr size_t kMostLevels = 10;

/// Corner k of the face has this place in the grid of its four cells; kAlong is the step along side k.
constexpr std::array<std::array<int, 2>, 4> kCorner = {{{1, 1}, {3, 1}, {3, 3}, {1, 3}}};
constexpr std::array<std::array<int, 2>, 4> kAlong = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Place of (x, y) in the axes of corner k, counted from it.
std::array<size_t, 2> find_place(size_t k, int x, int y) {
    const std::array<int, 2>&c = kCorner[k], &a = kAlong[k], &b = kAlong[(k + 1) & 3];
    return {size_t(c[0] + x * a[0] + y * b[0]), size_t(c[1] + x * a[1] + y * b[1])};
}

Vec3d find_mean(const std::array<Vec3d, PointFan::kMostEdges>& points, size_t count) {
    Vec3d sum{};
    for (size_t k = 0; k < count; ++k) sum = sum + points[k];
    return sum * (1.0 / double(count));
}

/// Cubic B-spline subdivision of four values (Lane and Riesenfeld 1980): between, at, between, at, between.
std::array<Vec3d, 5> subdivide_line(const std::array<Vec3d, 4>& p) {
    const auto between = [&](size_t k) { return (p[k] + p[k + 1]) * 0.5; };
    const auto at = [&](size_t k) { return p[k] * 0.75 + (p[k - 1] + p[k + 1]) * 0.125; };
    return {between(0), at(1), between(1), at(2), between(2)};
}

/// The fan after one more step: Catmull and Clark 1978.
PointFan subdivide_fan(const PointFan& fan) {
    PointFan next;
    const size_t n = next.count = fan.count;
    for (size_t k = 0; k < n; ++k)
        next.faces[k] = (fan.point + fan.edges[k] + fan.faces[k] + fan.edges[(k + 1) % n]) * 0.25;
    for (size_t k = 0; k < n; ++k)
        next.edges[k] = (fan.point + fan.edges[k] + next.faces[k] + next.faces[(k + n - 1) % n]) * 0.25;
    const Vec3d middles = (fan.point + find_mean(fan.edges, n)) * 0.5;
    next.point = (find_mean(next.faces, n) + middles * 2.0 + fan.point * (double(n) - 3)) * (1.0 / double(n));
    return next;
}

/// Controls of the cell whose first corner is at (i + 1, j + 1).
template <class Grid> SplineControls take_cell(const Grid& grid, size_t i, size_t j) {
    SplineControls controls;
    for (size_t x = 0; x < 4; ++x)
        for (size_t y = 0; y < 4; ++y) controls[x][y] = grid[i + x][j + y];
    return controls;
}

} // namespace

/// Position and tangents along the axes, whose lengths are those of derivatives at regular points (Halstead,
/// Kass and DeRose 1993).
LimitSample LimitCells::find_limit(const PointFan& fan) {
    const auto n = double(fan.count);
    const double turn = 2 * std::numbers::pi / n;
    const double weight = 1 + std::cos(turn) + std::cos(turn / 2) * std::sqrt(2 * (9 + std::cos(turn)));
    const auto find_tangent = [&](size_t first) {
        Vec3d sum{};
        for (size_t k = 0; k < fan.count; ++k) {
            const double at = std::cos(turn * (double(k) - double(first))),
                         next = std::cos(turn * (double(k) + 1 - double(first)));
            sum = sum + fan.edges[k] * (weight * at) + fan.faces[k] * (at + next);
        }
        return sum * (4 / (12 * n));
    };
    LimitSample limit;
    limit.position =
        (fan.point * n + find_mean(fan.edges, fan.count) * 4.0 + find_mean(fan.faces, fan.count)) *
        (1 / (n + 5));
    limit.du = find_tangent(0), limit.dv = find_tangent(1);
    return limit;
}

std::array<PointFan, 4> find_fans_of_part(const std::vector<PointFan>& corners, size_t part) {
    const size_t size = corners.size();
    const PointFan &own = corners[part], &next = corners[(part + 1) % size],
                   &before = corners[(part + size - 1) % size];
    const Vec3d middle = own.faces[0], here = own.edges[0], there = own.edges[1]; // beside the corner
    const PointFan along{4,
                         here,
                         {middle, own.point, own.faces[own.count - 1], next.point},
                         {there, own.edges[own.count - 1], next.edges[2], next.edges[0]}};
    const PointFan across{4,
                          there,
                          {own.point, middle, before.point, own.faces[1]},
                          {here, before.edges[1], before.edges[before.count - 1], own.edges[2]}};
    PointFan inside;
    inside.count = size, inside.point = middle;
    for (size_t k = 0; k < size; ++k) {
        const PointFan& corner = corners[(part + k) % size];
        inside.edges[k] = corner.edges[1], inside.faces[k] = corner.point;
    }
    return {subdivide_fan(own), subdivide_fan(along), subdivide_fan(inside), subdivide_fan(across)};
}

LimitCells::LimitCells(const std::array<PointFan, 4>& corners) {
    Grid grid{};
    const auto at = [&](size_t k, int x, int y) -> Vec3d& {
        const std::array<size_t, 2> place = find_place(k, x, y);
        return grid[place[0]][place[1]];
    };
    for (size_t k = 0; k < 4; ++k) {
        const PointFan& fan = corners[k];
        at(k, 0, 0) = fan.point;
        at(k, 1, 0) = fan.edges[0], at(k, 0, 1) = fan.edges[1], at(k, 1, 1) = fan.faces[0];
        at(k, 0, -1) = fan.edges[fan.count - 1], at(k, 1, -1) = fan.faces[fan.count - 1];
        at(k, -1, 0) = fan.edges[2], at(k, -1, 1) = fan.faces[1];
        if (fan.count == 4)
            at(k, -1, -1) = fan.faces[2];
        else
            irregular_corners_ |= 1u << k;
    }
    for (size_t k = 0; k < 4; ++k) {
        cells_[k] = take_cell(grid, size_t(kCorner[k][0] / 2), size_t(kCorner[k][1] / 2));
        if (corners[k].count == 4) continue;
        places_[k] = uint8_t(irregular_.size());
        Corner& corner = irregular_.emplace_back();
        corner.limit = find_limit(corners[k]);
        Ring& ring = corner.ring;
        ring.fan = corners[k];
        for (int x = 0; x < 4; ++x)
            for (int y = 0; y < 4; ++y)
                if (x > 0 || y > 0) ring.around[size_t(x)][size_t(y)] = at(k, x - 1, y - 1);
    }
}

/// Makes the cells around the one at the corner, and the ring of that one.
LimitCells::Level LimitCells::subdivide(Ring& ring) {
    ring.fan = subdivide_fan(ring.fan);
    std::array<std::array<Vec3d, 5>, 4> columns;
    for (size_t x = 0; x < 4; ++x) columns[x] = subdivide_line(ring.around[x]);
    Grid grid;
    for (size_t y = 0; y < 5; ++y) {
        const std::array<Vec3d, 5> row =
            subdivide_line({columns[0][y], columns[1][y], columns[2][y], columns[3][y]});
        for (size_t x = 0; x < 5; ++x) grid[x][y] = row[x];
    }
    // These depend on the point that has no meaning.
    grid[1][1] = ring.fan.point, grid[1][0] = ring.fan.edges[ring.fan.count - 1];
    grid[0][1] = ring.fan.edges[2];
    ring.around = take_cell(grid, 0, 0);
    return {take_cell(grid, 1, 0), take_cell(grid, 1, 1), take_cell(grid, 0, 1)};
}

LimitCells::Cell LimitCells::find_cell(double u, double v) const {
    const bool is_right = u >= 0.5, is_upper = v >= 0.5;
    const uint32_t k = is_upper ? (is_right ? 2 : 3) : (is_right ? 1 : 0);
    if ((irregular_corners_ >> k & 1) == 0)
        return {&cells_[k], 2 * u - double(is_right), 2 * v - double(is_upper), 2, 0};
    // From the corner along its sides, in cells of half the face.
    double x = 2 * (k == 0 ? u : k == 1 ? v : k == 2 ? 1 - u : 1 - v);
    double y = 2 * (k == 0 ? v : k == 1 ? 1 - u : k == 2 ? 1 - v : u);
    Corner& corner = irregular_[places_[k]];
    double scale = 2;
    if (x == 0 && y == 0) return {nullptr, 0, 0, scale, k, &corner};
    for (size_t level = 0;; ++level) {
        if (level == corner.levels.size()) corner.levels.push_back(subdivide(corner.ring));
        x *= 2, y *= 2, scale *= 2;
        const Level& here = corner.levels[level];
        if (x >= 1 || y >= 1) {
            const size_t cell = x < 1 ? 2 : y < 1 ? 0 : 1;
            return {&here[cell], x < 1 ? x : x - 1, y < 1 ? y : y - 1, scale, k};
        }
        if (level + 1 == kMostLevels) return {nullptr, x, y, scale, k, &corner};
    }
}

/// Interpolates between the corner and the cells around; at the corner the derivatives are its tangents.
LimitSample LimitCells::evaluate_innermost(const Cell& cell) {
    const Corner& corner = *cell.corner;
    if (cell.x == 0 && cell.y == 0) return corner.limit;
    const Level& around = corner.levels.back();
    const Vec3d& here = corner.limit.position;
    const Vec3d right = evaluate_spline_position(around[0], 0, 0),
                across = evaluate_spline_position(around[1], 0, 0),
                above = evaluate_spline_position(around[2], 0, 0);
    const double x = cell.x, y = cell.y;
    LimitSample sample;
    sample.position = (here * (1 - x) + right * x) * (1 - y) + (above * (1 - x) + across * x) * y;
    sample.du = (right - here) * (1 - y) + (across - above) * y;
    sample.dv = (above - here) * (1 - x) + (across - right) * x;
    sample.duv = here - right + across - above;
    return sample;
}

LimitSample LimitCells::evaluate(double u, double v, bool has_twist) const {
    const Cell cell = find_cell(u, v);
    LimitSample sample =
        cell.controls ? evaluate_spline(*cell.controls, cell.x, cell.y, has_twist) : evaluate_innermost(cell);
    const Vec3d dx = sample.du * cell.scale, dy = sample.dv * cell.scale;
    sample.duv = sample.duv * (cell.scale * cell.scale * (cell.turn % 2 == 0 ? 1 : -1));
    switch (cell.turn) {
    case 0:
        sample.du = dx, sample.dv = dy;
        break;
    case 1:
        sample.du = dy * -1.0, sample.dv = dx;
        break;
    case 2:
        sample.du = dx * -1.0, sample.dv = dy * -1.0;
        break;
    default:
        sample.du = dy, sample.dv = dx * -1.0;
    }
    return sample;
}

Vec3d LimitCells::evaluate_position(double u, double v) const {
    const Cell cell = find_cell(u, v);
    return cell.controls ? evaluate_spline_position(*cell.controls, cell.x, cell.y)
                         : evaluate_innermost(cell).position;
}

} // namespace relief
