// Closed displaced bodies and maps for tests, made from formulas.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "math/vec.h"
#include "relief/scene.h"

namespace relief::test {

/// Cube-sphere of 6 n^2 quads, radius 1; each face of the cube has its own square of the uv plane, so edges
/// are seams.
inline Mesh make_cube_sphere(uint32_t n) {
    Mesh mesh;
    mesh.name = "sphere";
    for (int face = 0; face < 6; ++face) {
        const uint32_t first = uint32_t(mesh.positions.size());
        for (uint32_t j = 0; j <= n; ++j)
            for (uint32_t i = 0; i <= n; ++i) {
                // tan of (k / n - 1/2) pi/2, odd about the middle so that faces meet bit for bit.
                const auto warp = [&](uint32_t k) {
                    const double a = std::tan((double(k) / n - 0.5) * std::numbers::pi / 2);
                    return float(k == 0 ? -1 : k == n ? 1 : a);
                };
                const float a = warp(i), b = warp(j);
                Vec3f p;
                switch (face) {
                case 0:
                    p = {1, a, b};
                    break;
                case 1:
                    p = {-1, b, a};
                    break;
                case 2:
                    p = {b, 1, a};
                    break;
                case 3:
                    p = {a, -1, b};
                    break;
                case 4:
                    p = {a, b, 1};
                    break;
                default:
                    p = {b, a, -1};
                    break;
                }
                const double length = std::sqrt(double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z);
                mesh.positions.push_back({float(p.x / length), float(p.y / length), float(p.z / length)});
                mesh.uvs.push_back({(float(face % 3) + float(i) / float(n)) / 3,
                                    (float(face / 3) + float(j) / float(n)) / 2});
            }
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i < n; ++i) {
                const uint32_t v = first + j * (n + 1) + i;
                mesh.face_sizes.push_back(4);
                for (const uint32_t corner : {v, v + 1, v + n + 2, v + n + 1})
                    mesh.position_indices.push_back(corner);
            }
    }
    mesh.uv_indices = mesh.position_indices;
    return mesh;
}

/// Torus of rows x columns quads, radii 1 and 0.45, uv wrapping at seams of both directions.
inline Mesh make_torus(uint32_t rows, uint32_t columns) {
    Mesh mesh;
    mesh.name = "torus";
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const double a = 2 * std::numbers::pi * i / columns, b = 2 * std::numbers::pi * j / rows;
            const double r = 1 + 0.45 * std::cos(b);
            mesh.positions.push_back(
                {float(r * std::cos(a)), float(0.45 * std::sin(b)), float(-r * std::sin(a))});
        }
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i)
            mesh.uvs.push_back({float(i) / float(columns), float(j) / float(rows)});
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t i1 = (i + 1) % columns, j1 = (j + 1) % rows;
            mesh.face_sizes.push_back(4);
            for (const uint32_t p : {j * columns + i, j * columns + i1, j1 * columns + i1, j1 * columns + i})
                mesh.position_indices.push_back(p);
            const uint32_t t = j * (columns + 1) + i;
            for (const uint32_t uv : {t, t + 1, t + columns + 2, t + columns + 1})
                mesh.uv_indices.push_back(uv);
        }
    return mesh;
}

/// Gives each face a normal of its own, so that every edge is hard.
inline void add_flat_normals(Mesh& mesh) {
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const auto position = [&](size_t k) { return mesh.positions[mesh.position_indices[first + k]]; };
        const Vec3f normal = normalize(cross(position(2) - position(0), position(size - 1) - position(1)));
        mesh.normal_indices.insert(mesh.normal_indices.end(), size, uint32_t(mesh.normals.size()));
        mesh.normals.push_back(normal);
        first += size;
    }
}

/// Smooth random vectors of length about `amplitude`, plus a little noise at texel scale.
inline std::shared_ptr<Texture> make_random_map(uint32_t width, uint32_t height, float amplitude,
                                                uint32_t seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    double phase[12], frequency[12];
    for (int k = 0; k < 12; ++k) phase[k] = 6.28 * uniform(), frequency[k] = std::floor(1 + 6 * uniform());
    auto map = std::make_shared<Texture>();
    map->width = width, map->height = height, map->channel_count = 3;
    map->source_type = SampleType::float32;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                double value = 0.2 * (uniform() - 0.5);
                for (int k = 0; k < 4; ++k)
                    value += 0.3 * std::sin(6.2831853 * (frequency[4 * c + k] * x / width +
                                                         frequency[(4 * c + k + 5) % 12] * y / height) +
                                            phase[4 * c + k]);
                map->floats.push_back(float(amplitude * value));
            }
            map->floats.push_back(1);
        }
    return map;
}

/// Leaves every `step`th face without uvs.
inline void remove_uvs(Mesh& mesh, size_t step) {
    size_t first = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); first += mesh.face_sizes[face], ++face)
        for (size_t k = 0; face % step == step - 1 && k < mesh.face_sizes[face]; ++k)
            mesh.uv_indices[first + k] = kNoIndex;
}

inline Displacement make_displacement(std::shared_ptr<const Texture> map, DisplacementSpace space) {
    Displacement displacement;
    displacement.name = "map";
    displacement.space = space;
    displacement.tiles.push_back({1001, std::move(map)});
    return displacement;
}

/// Has the first map go through other frames; where those of the file, all meshes get hard edges. Relative
/// lengths are about five times as long on these bodies.
inline void set_frames(Scene& scene, FrameKind frame, FrameLengths lengths) {
    Displacement& map = scene.displacements.at(0);
    map.frame = frame, map.lengths = lengths;
    if (lengths == FrameLengths::relative) map.scale = {0.2f, 0.25f, 1};
    if (frame == FrameKind::file)
        for (Mesh& mesh : scene.meshes) add_flat_normals(mesh);
}

/// A scene of one displaced body at the origin, camera inside.
inline Scene make_body_scene(Mesh mesh, Displacement displacement) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.displacements.push_back(std::move(displacement));
    Object object;
    object.name = "body";
    object.displacement = 0;
    scene.objects.push_back(object);
    scene.camera.from = {0.1f, 0.05f, 0.02f};
    scene.camera.to = {1, 0, 0};
    return scene;
}

} // namespace relief::test
