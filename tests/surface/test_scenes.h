// Small meshes and maps for the tests of this folder.
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "math/affine.h"
#include "relief/error.h"
#include "surface/map/displacement_map.h"
#include "surface/patch/surface.h"

namespace relief::test {

/// Texture of random values in [-reach, reach].
inline std::shared_ptr<Texture> make_noise(uint32_t width, uint32_t height, float reach, uint32_t seed) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    texture->file = "noise.exr";
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-reach, reach);
    for (size_t k = 0; k < size_t(4) * width * height; ++k) texture->floats.push_back(value(random));
    return texture;
}

inline std::shared_ptr<Texture> make_constant(uint32_t width, uint32_t height, const Vec3f& value) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    for (size_t k = 0; k < size_t(width) * height; ++k)
        texture->floats.insert(texture->floats.end(), {value.x, value.y, value.z, 1.0f});
    return texture;
}

inline Displacement make_displacement(std::shared_ptr<const Texture> texture) {
    Displacement displacement;
    displacement.name = "map";
    displacement.tiles.push_back({1001, std::move(texture)});
    return displacement;
}

inline void add_face(Mesh& mesh, const std::vector<uint32_t>& points, const std::vector<Vec2f>& uvs) {
    mesh.face_sizes.push_back(uint32_t(points.size()));
    for (size_t k = 0; k < points.size(); ++k) {
        mesh.position_indices.push_back(points[k]);
        if (uvs.empty()) continue;
        mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
        mesh.uvs.push_back(uvs[k]);
    }
}

/// One quad in the plane z = 0 with uv = xy.
inline Mesh make_plane() {
    Mesh mesh;
    mesh.name = "plane", mesh.source = "plane.obj";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    add_face(mesh, {0, 1, 2, 3}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    return mesh;
}

/// Grid of quads bent at random. Each face starts at a random corner; `seams` in [0, 1] is the share of faces
/// with uvs of their own, half of them mirrored.
inline Mesh make_random_grid(uint32_t width, uint32_t height, float seams, uint32_t seed) {
    Mesh mesh;
    mesh.name = "grid", mesh.source = "grid.obj";
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (uint32_t y = 0; y <= height; ++y)
        for (uint32_t x = 0; x <= width; ++x)
            mesh.positions.push_back(
                {float(x) + 0.3f * unit(random), float(y) + 0.3f * unit(random), unit(random)});
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t p = y * (width + 1) + x;
            const uint32_t points[4] = {p, p + 1, p + width + 2, p + width + 1};
            Vec2f uvs[4];
            for (int k = 0; k < 4; ++k)
                uvs[k] = {(float(x) + float(k == 1 || k == 2)) / float(width),
                          (float(y) + float(k >= 2)) / float(height)};
            if (unit(random) < seams) {
                const float shift = unit(random), sign = unit(random) < 0.5f ? -1.0f : 1.0f;
                for (Vec2f& uv : uvs) uv = {shift + sign * uv.x, uv.y * 0.7f + shift};
            }
            const uint32_t turn = random() % 4;
            std::vector<uint32_t> turned_points;
            std::vector<Vec2f> turned_uvs;
            for (uint32_t k = 0; k < 4; ++k) {
                turned_points.push_back(points[(k + turn) % 4]);
                turned_uvs.push_back(uvs[(k + turn) % 4]);
            }
            add_face(mesh, turned_points, turned_uvs);
        }
    return mesh;
}

/// Closed body of a quad and four triangles.
inline Mesh make_pyramid() {
    Mesh mesh;
    mesh.name = "pyramid";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 1}};
    add_face(mesh, {0, 3, 2, 1}, {{0, 0}, {0, 1}, {1, 1}, {1, 0}});
    for (uint32_t k = 0; k < 4; ++k) add_face(mesh, {k, (k + 1) % 4, 4}, {{0, 0}, {1, 0}, {0.5f, 1}});
    return mesh;
}

/// Samples of edge k of a patch in its own direction.
inline std::vector<Vec3f> evaluate_edge(const Surface& surface, uint32_t patch, const PatchLevels& levels,
                                        int edge) {
    const uint32_t n = 1u << levels.patch;
    std::vector<Vec3f> points;
    for (uint32_t k = 0; k <= n; ++k) {
        const uint32_t i = edge == 0 ? k : edge == 1 ? n : edge == 2 ? n - k : 0;
        const uint32_t j = edge == 0 ? 0 : edge == 1 ? k : edge == 2 ? n : n - k;
        points.push_back(evaluate_vertex(surface, patch, levels, i, j));
    }
    return points;
}

/// Distinct points along the edge, so that patches of different level compare.
inline std::vector<Vec3f> drop_repeats(const std::vector<Vec3f>& points) {
    std::vector<Vec3f> result;
    for (const Vec3f& p : points)
        if (result.empty() || !(result.back() == p)) result.push_back(p);
    return result;
}

/// Message of the Error that `call` throws; empty where it throws none.
template <class Call> std::string catch_message(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind() == ErrorKind::bad_input ? error.what() : "another kind";
    }
    return {};
}

} // namespace relief::test
