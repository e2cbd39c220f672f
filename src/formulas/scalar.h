// GLSL's vocabulary for the scalar C++ instance of the formulas.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "math/vec.h"

namespace relief::scalar {

using Float = float;
using Bool = bool;
using Uint = uint32_t;
using uint = uint32_t;
using Vec2 = relief::Vec2<float>;
using Vec3 = relief::Vec3<float>;

inline float select(bool condition, float a, float b) { return condition ? a : b; }
inline Vec3 select(bool condition, const Vec3& a, const Vec3& b) { return condition ? a : b; }
inline Vec2 select(bool condition, const Vec2& a, const Vec2& b) { return condition ? a : b; }
inline uint select(bool condition, uint a, uint b) { return condition ? a : b; }
/// Whether any lane is true; guards work that inactive lanes do not need.
inline bool is_any(bool condition) { return condition; }
inline float abs(float a) { return std::fabs(a); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float copy_sign(float size, float sign) { return std::copysign(size, sign); }
inline float clamp(float a, float low, float high) { return min(max(a, low), high); }
inline float mix(float a, float b, float f) { return a * (1.0f - f) + b * f; }
inline uint floatBitsToUint(float a) { return std::bit_cast<uint>(a); }
inline float uintBitsToFloat(uint a) { return std::bit_cast<float>(a); }
/// Bit index as in GLSL: -1 if no bit is set.
inline int findLSB(uint a) { return a == 0 ? -1 : std::countr_zero(a); }
inline int findMSB(uint a) { return 31 - std::countl_zero(a); }
inline int bitCount(uint a) { return std::popcount(a); }
/// Unit vector along a; (0, 0, 0) for a zero or non-finite vector.
inline Vec3 make_unit(const Vec3& a) { return relief::normalize(a); }
using relief::cross;
using relief::dot;
using relief::is_finite;
using relief::length;
using relief::max;
using relief::min;
using relief::normalize;
using std::ceil;
using std::exp;
using std::exp2;
using std::floor;
using std::fma;
using std::log2;
using std::pow;
using std::sqrt;
using std::tan;

} // namespace relief::scalar
