// The arithmetic of points and directions that programs need: the public value types have none. In a
// namespace of its own, since the library has operators of the same names.
#pragma once

#include <cmath>

#include "relief/types.h"

namespace relief::vectors {

inline Vec3f operator+(const Vec3f& a, const Vec3f& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3f operator-(const Vec3f& a, const Vec3f& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3f operator*(const Vec3f& a, float s) { return {a.x * s, a.y * s, a.z * s}; }

inline float dot(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3f cross(const Vec3f& a, const Vec3f& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(const Vec3f& a) { return std::sqrt(dot(a, a)); }

/// Unit vector; (0, 0, 0) of no direction.
inline Vec3f normalize(const Vec3f& a) {
    const float size = length(a);
    return size > 0 ? a * (1 / size) : Vec3f{};
}

/// Turned about a unit axis, anticlockwise as seen against it; radians.
inline Vec3f rotate(const Vec3f& v, const Vec3f& axis, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

inline Vec3f transform_vector(const Affine& m, const Vec3f& v) {
    return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
}

/// The vector that transform_vector takes to `v`, by Cramer's rule; (0, 0, 0) where the map is singular.
inline Vec3f untransform_vector(const Affine& m, const Vec3f& v) {
    const Vec3f a{m.rows[0].x, m.rows[1].x, m.rows[2].x};
    const Vec3f b{m.rows[0].y, m.rows[1].y, m.rows[2].y};
    const Vec3f c{m.rows[0].z, m.rows[1].z, m.rows[2].z};
    const float determinant = dot(a, cross(b, c));
    if (determinant == 0) return {};
    return Vec3f{dot(v, cross(b, c)), dot(a, cross(v, c)), dot(a, cross(b, v))} * (1 / determinant);
}

} // namespace relief::vectors
