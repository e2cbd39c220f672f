#include "bench/triangle_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace relief::bench {

namespace {

constexpr double kPi = std::numbers::pi;

void add_triangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
    const Vec3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const double ux = double(q.x) - p.x, uy = double(q.y) - p.y, uz = double(q.z) - p.z;
    const double vx = double(r.x) - p.x, vy = double(r.y) - p.y, vz = double(r.z) - p.z;
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    if (x * x + y * y + z * z == 0) return;
    mesh.face_sizes.push_back(3);
    mesh.position_indices.insert(mesh.position_indices.end(), {a, b, c});
}

/// A grid of columns x rows quads over [0, 1]^2, each cut in two; `place(u, v)` is the surface.
template <class Place> void add_sheet(Mesh& mesh, int columns, int rows, Place place) {
    const uint32_t first = uint32_t(mesh.positions.size()), stride = uint32_t(columns) + 1;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            mesh.positions.push_back(place(double(i) / columns, double(j) / rows));
    for (uint32_t j = 0; j < uint32_t(rows); ++j)
        for (uint32_t i = 0; i < uint32_t(columns); ++i) {
            const uint32_t corner = first + j * stride + i;
            add_triangle(mesh, corner, corner + 1, corner + stride + 1);
            add_triangle(mesh, corner, corner + stride + 1, corner + stride);
        }
}

Vec3f to_point(double x, double y, double z) { return {float(x), float(y), float(z)}; }

/// Waves that no symmetry of the body repeats.
double compute_bump(double x, double y, double z) {
    return 0.12 * std::sin(2.3 * x + 1.1 * y) * std::cos(2.9 * z - 0.4 * x) +
           0.04 * std::sin(9.1 * y + 3 * x) * std::sin(8.3 * z + 2 * y) +
           0.012 * std::sin(31 * x) * std::sin(29 * y + 5 * z) * std::sin(33 * z);
}

/// One side of a cube, blown up to the body; the corners of sides meet exactly.
Vec3f place_on_body(int axis, double sign, double u, double v) {
    double p[3];
    p[axis] = sign;
    p[(axis + 1) % 3] = sign * std::tan((2 * u - 1) * kPi / 4);
    p[(axis + 2) % 3] = std::tan((2 * v - 1) * kPi / 4);
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double x = p[0] / length, y = p[1] / length, z = p[2] / length;
    const double radius = 1 + compute_bump(x, y, z);
    return to_point(radius * x, radius * y, radius * z);
}

void add_column(Mesh& mesh, double x, double z, int around, int along) {
    add_sheet(mesh, around, along, [&](double u, double v) {
        const double angle = -2 * kPi * u;
        const double flute = 0.03 * std::fabs(std::sin(10 * angle));
        const double base = 0.2 * std::exp(-18 * v) + 0.25 * std::exp(-14 * (1 - v));
        const double radius = 0.42 - 0.05 * v - flute + base;
        return to_point(x + radius * std::cos(angle), 6 * v, z + radius * std::sin(angle));
    });
}

void add_curtain(Mesh& mesh, double x, int columns, int rows) {
    add_sheet(mesh, columns, rows, [&](double u, double v) {
        const double fold =
            0.18 * std::sin(40 * u) * (0.4 + 0.6 * (1 - v)) + 0.03 * std::sin(130 * u + 9 * v);
        return to_point(x + 3 * u, 2.5 + 3 * v, -3.9 + fold);
    });
}

/// Six flat sides seen from inside, a few large tiles each.
void add_room(Mesh& mesh, int tiles) {
    const auto add_side = [&](Vec3f origin, Vec3f along, Vec3f up) {
        add_sheet(mesh, tiles, tiles, [&](double u, double v) {
            return to_point(origin.x + along.x * u + up.x * v, origin.y + along.y * u + up.y * v,
                            origin.z + along.z * u + up.z * v);
        });
    };
    add_side({-15, 0, -5}, {0, 0, 10}, {30, 0, 0});
    add_side({-15, 8, -5}, {30, 0, 0}, {0, 0, 10});
    add_side({-15, 0, -5}, {30, 0, 0}, {0, 8, 0});
    add_side({15, 0, 5}, {-30, 0, 0}, {0, 8, 0});
    add_side({-15, 0, 5}, {0, 0, -10}, {0, 8, 0});
    add_side({15, 0, -5}, {0, 0, 10}, {0, 8, 0});
}

} // namespace

TriangleMesh make_bumpy_body(int side) {
    TriangleMesh result{"body", {}, {}};
    result.mesh.name = result.name;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            add_sheet(result.mesh, side, side,
                      [&](double u, double v) { return place_on_body(axis, sign, u, v); });
    result.camera.from = {1.6f, 1.1f, 2.6f}, result.camera.to = {0, 0, 0};
    result.camera.fov_degrees = 42;
    return result;
}

TriangleMesh make_hall(double detail) {
    TriangleMesh result{"hall", {}, {}};
    result.mesh.name = result.name;
    const double side = std::sqrt(detail);
    const auto scale = [&](int count) { return std::max(4, int(std::lround(count * side))); };
    add_room(result.mesh, scale(12));
    for (int row = 0; row < 2; ++row)
        for (int k = 0; k < 9; ++k)
            add_column(result.mesh, -12 + 3 * k, row ? 2.6 : -2.6, scale(80), scale(70));
    for (int k = 0; k < 4; ++k) add_curtain(result.mesh, -12 + 6 * k, scale(140), scale(66));
    result.camera.from = {-13.5f, 3.2f, 0.7f}, result.camera.to = {6, 2.4f, -0.9f};
    result.camera.fov_degrees = 62;
    return result;
}

TriangleMesh make_triangle_mesh(const std::string& name, Mesh mesh) {
    TriangleMesh result{name, {}, {}};
    result.mesh.name = mesh.name, result.mesh.source = mesh.source;
    result.mesh.positions = std::move(mesh.positions);
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const uint32_t* corner = mesh.position_indices.data() + first;
        for (uint32_t k = 2; k < size; ++k) add_triangle(result.mesh, corner[0], corner[k - 1], corner[k]);
        first += size;
    }
    Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const Vec3f& p : result.mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3f middle{(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
    const float size = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    result.camera.to = middle;
    result.camera.from = {middle.x + 0.45f * size, middle.y + 0.35f * size, middle.z + 0.95f * size};
    result.camera.fov_degrees = 50;
    return result;
}

} // namespace relief::bench
