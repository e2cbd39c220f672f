#include "samples/shapes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>

#include "math/vec.h"
#include "samples/angles.h"

namespace relief::samples {

namespace {

void add_face(Mesh& mesh, std::initializer_list<uint32_t> corners) {
    mesh.face_sizes.push_back(uint32_t(corners.size()));
    mesh.position_indices.insert(mesh.position_indices.end(), corners);
}

/// Twelve vertices and twenty faces.
Mesh make_icosahedron() {
    Mesh mesh;
    const float g = (1 + std::sqrt(5.0f)) / 2;
    const Vec3f corners[] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (const Vec3f& p : corners) mesh.positions.push_back(normalize(p));
    mesh.position_indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                             4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                             6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    mesh.face_sizes.assign(20, 3);
    return mesh;
}

Mesh split_faces(const Mesh& coarse) {
    Mesh mesh;
    mesh.positions = coarse.positions;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
        const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), uint32_t(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(normalize(coarse.positions[a] + coarse.positions[b]));
        return place->second;
    };
    for (size_t f = 0; f < coarse.face_sizes.size(); ++f) {
        const uint32_t a = coarse.position_indices[3 * f], b = coarse.position_indices[3 * f + 1];
        const uint32_t c = coarse.position_indices[3 * f + 2];
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        add_face(mesh, {a, ab, ca});
        add_face(mesh, {ab, b, bc});
        add_face(mesh, {ca, bc, c});
        add_face(mesh, {ab, bc, ca});
    }
    return mesh;
}

} // namespace

Mesh make_plane(float half_size, int cells) {
    Mesh mesh;
    mesh.name = "plane";
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const float u = float(x) / float(cells), v = float(y) / float(cells);
            mesh.positions.push_back({half_size * (2 * u - 1), 0, half_size * (1 - 2 * v)});
            mesh.uvs.push_back({u, v});
        }
    for (uint32_t y = 0; y < uint32_t(cells); ++y)
        for (uint32_t x = 0; x < uint32_t(cells); ++x) {
            const uint32_t a = y * uint32_t(cells + 1) + x, d = a + uint32_t(cells + 1);
            add_face(mesh, {a, a + 1, d + 1, d});
        }
    mesh.uv_indices = mesh.position_indices;
    return mesh;
}

Mesh make_single_quad() {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    add_face(mesh, {0, 1, 2, 3});
    mesh.uv_indices = mesh.position_indices;
    return mesh;
}

Mesh make_torus(const TorusShape& shape, const Deformation& deform) {
    Mesh mesh;
    mesh.name = "torus";
    const int columns = shape.major_cells, rows = shape.minor_cells;
    for (int i = 0; i <= columns; ++i)
        for (int j = 0; j <= rows; ++j) {
            const float u = float(i) / float(columns), v = float(j) / float(rows);
            mesh.uvs.push_back({u * shape.uv_repeats, v});
            if (i == columns || j == rows) continue;
            const float ring = 2 * kPi * u, tube = 2 * kPi * v;
            const float r = shape.major_radius + shape.minor_radius * std::cos(tube);
            mesh.positions.push_back(
                deform({r * std::cos(ring), shape.minor_radius * std::sin(tube), -r * std::sin(ring)}));
        }
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            mesh.face_sizes.push_back(4);
            for (const auto& [di, dj] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                mesh.position_indices.push_back(uint32_t(((i + di) % columns) * rows + (j + dj) % rows));
                mesh.uv_indices.push_back(uint32_t((i + di) * (rows + 1) + j + dj));
            }
        }
    return mesh;
}

Mesh make_icosphere(int splits, Shading shading) {
    Mesh mesh = make_icosahedron();
    for (int k = 0; k < splits; ++k) mesh = split_faces(mesh);
    mesh.name = "icosphere";
    if (shading == Shading::smooth) {
        mesh.normals = mesh.positions;
        mesh.normal_indices = mesh.position_indices;
    }
    return mesh;
}

Mesh make_gem(int sides) {
    Mesh mesh;
    mesh.name = "gem";
    const uint32_t n = uint32_t(sides);
    const auto add_ring = [&](float radius, float y, float turn) {
        for (uint32_t i = 0; i < n; ++i) {
            const float angle = 2 * kPi * (float(i) + turn) / float(n);
            mesh.positions.push_back({radius * std::cos(angle), y, -radius * std::sin(angle)});
        }
    };
    add_ring(0.30f, 0.20f, 0);
    add_ring(0.50f, 0.02f, 0.5f);
    add_ring(0.50f, -0.04f, 0.5f);
    const uint32_t table = uint32_t(mesh.positions.size()), tip = table + 1;
    mesh.positions.push_back({0, 0.20f, 0});
    mesh.positions.push_back({0, -0.46f, 0});
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t next = (i + 1) % n;
        add_face(mesh, {table, i, next});
        add_face(mesh, {i, n + i, next});
        add_face(mesh, {next, n + i, n + next});
        add_face(mesh, {n + i, 2 * n + i, n + next});
        add_face(mesh, {n + next, 2 * n + i, 2 * n + next});
        add_face(mesh, {2 * n + i, tip, 2 * n + next});
    }
    return mesh;
}

} // namespace relief::samples
