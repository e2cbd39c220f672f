// 2- and 3-vectors over any lane type. The order of operations is fixed: watertight edges need it.
#pragma once

#include <cmath>

#include "relief/types.h"

namespace relief {

template <class T> constexpr Vec2<T> operator+(const Vec2<T>& a, const Vec2<T>& b) {
    return {a.x + b.x, a.y + b.y};
}
template <class T> constexpr Vec2<T> operator-(const Vec2<T>& a, const Vec2<T>& b) {
    return {a.x - b.x, a.y - b.y};
}
template <class T> constexpr Vec2<T> operator*(const Vec2<T>& a, const T& s) { return {a.x * s, a.y * s}; }
template <class T> constexpr Vec2<T> operator*(const T& s, const Vec2<T>& a) { return {a.x * s, a.y * s}; }

template <class T> constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> constexpr Vec3<T> operator-(const Vec3<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> constexpr Vec3<T> operator*(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T> constexpr Vec3<T> operator*(const Vec3<T>& a, const T& s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class T> constexpr Vec3<T> operator*(const T& s, const Vec3<T>& a) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class T> constexpr Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) { return a = a + b; }
template <class T> constexpr Vec3<T>& operator*=(Vec3<T>& a, const T& s) { return a = a * s; }
constexpr Vec3f operator/(const Vec3f& a, float s) { return {a.x / s, a.y / s, a.z / s}; }

template <class T> constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline float length(const Vec3f& a) { return std::sqrt(dot(a, a)); }
inline float length(const Vec2f& a) { return std::sqrt(a.x * a.x + a.y * a.y); }

/// Unit vector along a; (0, 0, 0) for a zero, denormal or non-finite vector.
inline Vec3f normalize(const Vec3f& a) {
    const float squared = dot(a, a);
    if (!(squared > 1e-37f) || !std::isfinite(squared)) {
        const float largest = std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z)));
        if (!(largest > 0) || !std::isfinite(largest)) return {};
        const Vec3f scaled = a / largest;
        return scaled / std::sqrt(dot(scaled, scaled));
    }
    return a / std::sqrt(squared);
}

inline Vec3f min(const Vec3f& a, const Vec3f& b) {
    return {std::fmin(a.x, b.x), std::fmin(a.y, b.y), std::fmin(a.z, b.z)};
}
inline Vec3f max(const Vec3f& a, const Vec3f& b) {
    return {std::fmax(a.x, b.x), std::fmax(a.y, b.y), std::fmax(a.z, b.z)};
}
inline float get_component(const Vec3f& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
inline void set_component(Vec3f& a, int axis, float value) {
    (axis == 0 ? a.x : axis == 1 ? a.y : a.z) = value;
}
inline bool is_finite(const Vec3f& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

} // namespace relief
