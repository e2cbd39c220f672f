// Base meshes of the sample scenes: quads with smooth uvs and no face without area.
#pragma once

#include <functional>

#include "relief/scene.h"

namespace relief::samples {

/// A point of a body, for shaping it: given the plain position, where it goes.
using Deformation = std::function<Vec3f(const Vec3f&)>;

/// A flat square in the xz plane, y = 0, normal up, `cells` quads a side, uv [0, 1]^2.
Mesh make_plane(float half_size, int cells);

/// One quad in the xy plane, [-1, 1]^2, normal +z, uv [0, 1]^2.
Mesh make_single_quad();

struct TorusShape {
    float major_radius = 1, minor_radius = 0.35f;
    int major_cells = 48, minor_cells = 16;
    float uv_repeats = 1; ///< copies of the map along the ring; one copy goes around the tube; an integer
};

/// Torus about the y axis: u runs along the ring, v around the tube.
Mesh make_torus(const TorusShape& shape, const Deformation& deform);

/// Sphere of triangles: an icosahedron split `splits` times; without normals its facets show.
enum class Shading { faceted, smooth };
Mesh make_icosphere(int splits, Shading shading);

/// A cut stone of triangles, about one unit wide, point down: crown, girdle and pavilion.
Mesh make_gem(int sides);

} // namespace relief::samples
