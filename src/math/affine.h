// Affine transforms: build, compose, invert, apply. Read right to left: world_from_object.
#pragma once

#include <optional>

#include "math/box.h"
#include "math/vec.h"

namespace relief {

inline Vec3f transform_vector(const Affine& m, const Vec3f& v) {
    return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
}
inline Vec3f transform_point(const Affine& m, const Vec3f& p) {
    return transform_vector(m, p) + m.translation;
}

/// Normal n of a surface under the map whose inverse is `inverse`: transpose(inverse) n, not normalised.
inline Vec3f transform_normal(const Affine& inverse, const Vec3f& n) {
    return inverse.rows[0] * n.x + inverse.rows[1] * n.y + inverse.rows[2] * n.z;
}

Affine compose(const Affine& outer, const Affine& inner);

/// Determinant of the linear part; negative for a mirror.
float compute_determinant(const Affine& m);

/// No vector becomes longer by more than this factor.
double bound_scale(const Affine& m);

/// Inverse, computed in double precision; nullopt for a singular or non-finite map.
std::optional<Affine> invert(const Affine& m);

/// Conservative bounds of the transformed box, rounding of the transform included.
Box transform_box(const Affine& m, const Box& box);

Affine make_translation(const Vec3f& offset);
Affine make_scale(const Vec3f& factors);
/// Rotation about x, then y, then z, in degrees.
Affine make_rotation_degrees(const Vec3f& degrees);

} // namespace relief
