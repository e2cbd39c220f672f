// Value types of the public interface: small vectors and affine transforms. Their arithmetic is internal
// (src/math).
#pragma once

#include <array>
#include <cstdint>

namespace relief {

template <class T> struct Vec2 {
    T x{}, y{};
    friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T> struct Vec3 {
    T x{}, y{}, z{};
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;

/// Affine map p -> (dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)) + translation; row-major 3x3 part.
struct Affine {
    std::array<Vec3f, 3> rows{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
    Vec3f translation{};
    friend constexpr bool operator==(const Affine&, const Affine&) = default;
};

inline constexpr uint32_t kNoIndex = 0xffffffffu;

} // namespace relief
