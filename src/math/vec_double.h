// Vectors of double, for sums and small differences of what is kept in float.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace relief {

using Vec3d = Vec3<double>;

inline Vec3d to_double(const Vec3f& a) { return {a.x, a.y, a.z}; }
inline Vec3f to_float(const Vec3d& a) { return {float(a.x), float(a.y), float(a.z)}; }
inline double compute_length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

/// Of a vector in a plane. Not std::hypot: its rounding depends on the C library, and it needs glibc 2.35.
inline double compute_length(double x, double y) { return std::sqrt(x * x + y * y); }

/// Unit vector, or zero.
inline Vec3d normalize_double(const Vec3d& a) {
    const double size = compute_length(a);
    return size > 0 ? Vec3d{a.x / size, a.y / size, a.z / size} : Vec3d{};
}

} // namespace relief
