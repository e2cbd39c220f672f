// Plain triangle meshes to measure tracers with: the two classes of the literature, from formulas.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief::bench {

struct TriangleMesh {
    std::string name;
    Mesh mesh; ///< triangles only
    Camera camera;
};

/// A closed body with bumps of three sizes, 12 `side`^2 triangles, seen from outside: the class of the
/// Stanford bunny at side 76.
TriangleMesh make_bumpy_body(int side);

/// A hall with two rows of fluted columns, curtains and a floor of few large tiles, seen from inside: sizes
/// of triangles differ a thousand times, as in Sponza; about 280,000 triangles at `detail` 1, which scales
/// their number.
TriangleMesh make_hall(double detail);

/// Any mesh: faces cut into fans, those without area left out, the camera in front of its box.
TriangleMesh make_triangle_mesh(const std::string& name, Mesh mesh);

} // namespace relief::bench
