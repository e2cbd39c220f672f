// Meshes for tests of subdivision: irregular points, polygons, boundaries, creases.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include "surface/test_scenes.h"

namespace relief::test {

enum class Shape {
    cube,
    pyramid,
    grid,
    creased_cube,
    semi_sharp_cube,
    sharp_corner_grid,
    tangled_cube,     ///< semi-sharp creases that end, turn and change, and a semi-sharp point
    crossed_grid,     ///< semi-sharp creases that cross, end and meet the boundary
    creased_pyramid,  ///< semi-sharp creases along triangles
    changing_grid,    ///< a semi-sharp crease that goes on straight with another sharpness
    pole,             ///< nine quads around a point
    sharp_point_grid, ///< a semi-sharp point that takes longer to wear off than other points have rings
    fine_cube         ///< extraordinary points, a triangle and a pentagon among many regular quads
};

inline constexpr Shape kAllShapes[] = {Shape::cube,
                                       Shape::pyramid,
                                       Shape::grid,
                                       Shape::creased_cube,
                                       Shape::semi_sharp_cube,
                                       Shape::sharp_corner_grid,
                                       Shape::tangled_cube,
                                       Shape::crossed_grid,
                                       Shape::creased_pyramid,
                                       Shape::changing_grid,
                                       Shape::pole,
                                       Shape::sharp_point_grid};

inline void PrintTo(Shape shape, std::ostream* stream) { *stream << int(shape); }

/// Six quads, each with the whole unit square.
inline Mesh make_cube() {
    Mesh mesh;
    mesh.name = "cube";
    for (uint32_t k = 0; k < 8; ++k)
        mesh.positions.push_back({k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f});
    const std::vector<Vec2f> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const std::vector<uint32_t>& face : std::vector<std::vector<uint32_t>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        add_face(mesh, face, uvs);
    return mesh;
}

/// Quads around a point that is above all others.
inline Mesh make_pole(uint32_t quad_count) {
    Mesh mesh;
    mesh.name = "pole";
    mesh.positions = {{0, 0, 1}};
    for (uint32_t k = 0; k < 2 * quad_count; ++k) {
        const double angle = std::numbers::pi * k / quad_count;
        mesh.positions.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
    }
    for (uint32_t k = 0; k < 2 * quad_count; k += 2)
        add_face(mesh, {0, k + 1, k + 2, (k + 2) % (2 * quad_count) + 1}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    return mesh;
}

/// A closed cube with extraordinary points at its corners: 5 x 5 quads per side, in two of which a quad is
/// cut into triangles or joined with a half of the next one to a pentagon. Each side is an island of curved
/// uvs.
inline Mesh make_fine_cube() {
    constexpr int kSide = 5;
    Mesh mesh;
    mesh.name = "fine cube";
    using Place = std::array<int, 2>;
    const auto add = [&](int side, const std::vector<Place>& places) {
        std::vector<uint32_t> points;
        std::vector<Vec2f> uvs;
        for (const auto& [x, y] : places) {
            const float a = 2.0f * float(x) / kSide - 1, b = 2.0f * float(y) / kSide - 1;
            const Vec3f at[] = {{a, b, 1}, {b, a, -1}, {1, a, b}, {-1, b, a}, {b, 1, a}, {a, -1, b}};
            const Vec3f& p = at[side];
            // Bent, so that no side is flat or symmetric.
            const Vec3f bent{p.x + 0.15f * std::sin(2 * p.y), p.y + 0.1f * std::sin(3 * p.z),
                             p.z + 0.15f * std::sin(2 * p.x + p.y)};
            const auto known = std::find(mesh.positions.begin(), mesh.positions.end(), bent);
            points.push_back(uint32_t(known - mesh.positions.begin()));
            if (known == mesh.positions.end()) mesh.positions.push_back(bent);
            uvs.push_back({float(side) + 0.4f + 0.3f * a + 0.05f * b * b + 0.05f * std::cos(3 * a + 1),
                           0.5f + 0.35f * b + 0.04f * std::sin(3 * a)});
        }
        add_face(mesh, points, uvs);
    };
    for (int side = 0; side < 6; ++side)
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const Place p{i, j}, q{i + 1, j}, r{i + 1, j + 1}, s{i, j + 1};
                if (side == 0 && i == 2 && j == 2)
                    add(side, {p, q, r}), add(side, {p, r, s});
                else if (side == 1 && i == 1 && j == 2)
                    add(side, {p, q, {i + 2, j + 1}, r, s});
                else if (side == 1 && i == 2 && j == 2)
                    add(side, {p, q, r});
                else
                    add(side, {p, q, r, s});
            }
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    return mesh;
}

inline Mesh make_shape(Shape shape) {
    Mesh mesh;
    switch (shape) {
    case Shape::fine_cube:
        mesh = make_fine_cube();
        break;
    case Shape::pyramid:
    case Shape::creased_pyramid:
        mesh = make_pyramid();
        break;
    case Shape::grid:
    case Shape::sharp_corner_grid:
    case Shape::crossed_grid:
    case Shape::changing_grid:
    case Shape::sharp_point_grid:
        mesh = make_random_grid(4, 3, 0, 9);
        mesh.subdivision.boundary =
            shape == Shape::sharp_corner_grid ? BoundaryRule::edge_and_corner : BoundaryRule::edge_only;
        break;
    case Shape::pole:
        mesh = make_pole(9);
        break;
    default:
        mesh = make_cube();
    }
    const float sharpness = shape == Shape::creased_cube      ? 10.0f
                            : shape == Shape::semi_sharp_cube ? 4.3f
                                                              : 0.0f;
    if (sharpness > 0)
        mesh.creases = {{4, 5, sharpness}, {5, 7, sharpness}, {7, 6, sharpness}, {6, 4, sharpness}};
    if (shape == Shape::tangled_cube)
        mesh.creases = {{4, 5, 3.5f}, {5, 7, 2.2f}, {0, 1, 6.0f}, {1, 3, 6.0f}, {3, 2, 4.0f}, {6, 6, 3.0f}};
    if (shape == Shape::crossed_grid)
        mesh.creases = {{2, 7, 3.0f}, {7, 12, 3.0f}, {6, 7, 5.0f}, {7, 8, 5.0f}, {8, 13, 4.5f}};
    if (shape == Shape::creased_pyramid) mesh.creases = {{0, 1, 4.0f}, {1, 2, 4.0f}, {0, 4, 2.5f}};
    if (shape == Shape::changing_grid) mesh.creases = {{6, 7, 6.0f}, {7, 8, 4.5f}};
    if (shape == Shape::sharp_point_grid) {
        mesh.creases = {{7, 7, 9.0f}};
        mesh.positions[7].z += 0.1f;
    }
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    mesh.subdivision.level = 2;
    return mesh;
}

} // namespace relief::test
