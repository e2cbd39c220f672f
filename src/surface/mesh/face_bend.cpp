#include "surface/mesh/face_bend.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

constexpr size_t kCount = 4; // places per side: 0, 1/3, 2/3, 1

template <class Value> using Grid = std::array<std::array<Value, kCount>, kCount>; // [along u][along v]

Vec3d subtract_part_along(const Vec3d& a, const Vec3d& direction) {
    const double size = dot(direction, direction);
    return size > 0 ? a - direction * (dot(a, direction) / size) : a;
}

/// Differences of the two inner values of a line from those between its ends.
template <class Value> std::array<Value, 2> find_differences(const std::array<Value, kCount>& line) {
    return {line[1] - (line[0] * 2.0 + line[3]) * (1.0 / 3), line[2] - (line[0] + line[3] * 2.0) * (1.0 / 3)};
}

template <class Value>
std::array<Value, kCount> take_line(const Grid<Value>& grid, size_t direction, size_t k) {
    if (direction == 1) return grid[k];
    return {grid[0][k], grid[1][k], grid[2][k], grid[3][k]};
}

template <class Value> Value find_twist(const Grid<Value>& grid) {
    return grid[0][0] - grid[3][0] + grid[3][3] - grid[0][3];
}

/// Only what is off the surface counts inside and on smooth edges; on sharp ones all that is off the line.
double measure_positions(const Grid<Vec3d>& points, const Grid<Vec3d>& normals, size_t direction,
                         const std::array<bool, 4>& is_sharp) {
    double largest = 0;
    for (size_t k = 0; k < kCount; ++k) {
        const std::array<Vec3d, kCount> line = take_line(points, direction, k),
                                        normal = take_line(normals, direction, k);
        const std::array<Vec3d, 2> off = find_differences(line);
        const size_t side = direction == 0 ? (k == 0 ? 0 : 2) : (k == 0 ? 3 : 1);
        const bool is_on_sharp = (k == 0 || k == kCount - 1) && is_sharp[side];
        for (size_t n = 0; n < 2; ++n)
            largest =
                std::max(largest, is_on_sharp ? compute_length(subtract_part_along(off[n], line[3] - line[0]))
                                              : std::fabs(dot(off[n], normal[n + 1])));
    }
    return largest;
}

double measure_directions(const Grid<Vec3d>& directions, size_t direction) {
    double largest = 0;
    for (size_t k = 0; k < kCount; ++k)
        for (const Vec3d& off : find_differences(take_line(directions, direction, k)))
            largest = std::max(largest, compute_length(off));
    return largest;
}

Vec2<double> measure_uvs(const Grid<Vec3d>& uvs, size_t direction) {
    Vec2<double> largest{};
    for (size_t k = 0; k < kCount; ++k)
        for (const Vec3d& off : find_differences(take_line(uvs, direction, k)))
            largest = {std::max(largest.x, std::fabs(off.x)), std::max(largest.y, std::fabs(off.y))};
    return largest;
}

void measure_uv_bend(const Grid<Vec3d>& points, FaceBend& bend) {
    for (size_t direction = 0; direction < 2; ++direction)
        bend.uv[direction] = measure_uvs(points, direction);
    const Vec3d twist = find_twist(points);
    bend.uv_twist = {std::fabs(twist.x), std::fabs(twist.y)};
}

double place_of(size_t k) { return double(k) / (kCount - 1); }

} // namespace

FaceBend measure_bend(const LimitFace* positions, const LimitFace* uvs, uint32_t part,
                      const std::array<bool, 4>& is_sharp) {
    Grid<Vec3d> points, normals, tangents, uv_points{};
    FaceBend bend;
    if (!positions) {
        for (size_t i = 0; i < kCount; ++i)
            for (size_t j = 0; j < kCount && uvs; ++j)
                uv_points[i][j] = uvs->evaluate_position(part, place_of(i), place_of(j));
        measure_uv_bend(uv_points, bend);
        return bend;
    }
    for (size_t i = 0; i < kCount; ++i)
        for (size_t j = 0; j < kCount; ++j) {
            const LimitSample sample = positions->evaluate(part, place_of(i), place_of(j));
            points[i][j] = sample.position;
            normals[i][j] = normalize_double(cross(sample.du, sample.dv));
            tangents[i][j] = normalize_double(sample.du);
            if (!uvs) continue;
            const LimitSample uv = uvs->evaluate(part, place_of(i), place_of(j));
            uv_points[i][j] = uv.position;
            const double turned = uv.du.x * uv.dv.y - uv.du.y * uv.dv.x, area = std::fabs(turned);
            const Vec3d along_u = (sample.du * uv.dv.y - sample.dv * uv.du.y) * (turned < 0 ? -1.0 : 1.0);
            if (area > 0) tangents[i][j] = normalize_double(along_u);
            const double size = compute_length(cross(sample.du, sample.dv));
            if (area > 0) bend.stretch = std::max(bend.stretch, std::sqrt(size / area));
        }
    for (size_t direction = 0; direction < 2; ++direction) {
        bend.position[direction] = measure_positions(points, normals, direction, is_sharp);
        bend.normal[direction] = measure_directions(normals, direction);
        bend.tangent[direction] = measure_directions(tangents, direction);
    }
    bend.position_twist = std::fabs(dot(find_twist(points), normals[1][1]));
    bend.normal_twist = compute_length(find_twist(normals));
    bend.tangent_twist = compute_length(find_twist(tangents));
    measure_uv_bend(uv_points, bend);
    return bend;
}

BendAlong find_bend_along(const FaceBend& bend, const Vec2<double>& step) {
    const double u = step.x * step.x, v = step.y * step.y, both = std::fabs(step.x * step.y) / 4;
    return {bend.position[0] * u + bend.position[1] * v + bend.position_twist * both,
            bend.normal[0] * u + bend.normal[1] * v + bend.normal_twist * both,
            bend.tangent[0] * u + bend.tangent[1] * v + bend.tangent_twist * both,
            bend.uv[0] * u + bend.uv[1] * v + bend.uv_twist * both};
}

} // namespace relief
