// Meshes for tests of subdivision: irregular points, polygons, boundaries, creases.
#pragma once

#include <ostream>
#include <vector>

#include "surface/test_scenes.h"

namespace relief::test {

enum class Shape { cube, pyramid, grid, creased_cube, semi_sharp_cube, sharp_corner_grid };

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

inline Mesh make_shape(Shape shape) {
    Mesh mesh;
    switch (shape) {
    case Shape::pyramid:
        mesh = make_pyramid();
        break;
    case Shape::grid:
    case Shape::sharp_corner_grid:
        mesh = make_random_grid(4, 3, 0, 9);
        mesh.subdivision.boundary =
            shape == Shape::grid ? BoundaryRule::edge_only : BoundaryRule::edge_and_corner;
        break;
    default:
        mesh = make_cube();
    }
    const float sharpness = shape == Shape::creased_cube      ? 10.0f
                            : shape == Shape::semi_sharp_cube ? 1.7f
                                                              : 0.0f;
    if (sharpness > 0)
        mesh.creases = {{4, 5, sharpness}, {5, 7, sharpness}, {7, 6, sharpness}, {6, 4, sharpness}};
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    mesh.subdivision.level = 2;
    return mesh;
}

} // namespace relief::test
