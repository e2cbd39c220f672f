// Texels of half precision (Texture::halves, IEEE 754 binary16) as floats: exact, and back, rounded to
// nearest.
#pragma once

#include <bit>
#include <cstdint>

namespace relief {

/// Infinities and NaN stay what they are.
inline float half_to_float(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000u) << 16;
    const uint32_t exponent_and_mantissa = uint32_t(half & 0x7fffu) << 13;
    // 2^112 moves the exponent's bias from 15 to 127, and the product makes subnormals normal.
    const float scaled = std::bit_cast<float>(exponent_and_mantissa) * std::bit_cast<float>(0x77800000u);
    const uint32_t special = (half & 0x7c00u) == 0x7c00u ? exponent_and_mantissa | 0x7f800000u : 0u;
    return std::bit_cast<float>(sign | (special != 0 ? special : std::bit_cast<uint32_t>(scaled)));
}

/// Rounds a finite value to nearest, ties to even; values out of range become the largest finite half.
inline uint16_t float_to_half(float value) {
    const uint32_t bits = std::bit_cast<uint32_t>(value), sign = (bits >> 16) & 0x8000u;
    const uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude >= 0x477fe000u) return uint16_t(sign | 0x7bffu);
    if (magnitude < 0x38800000u) {
        // Below the normal halves the sum with 0.5 rounds to multiples of 2^-24, their spacing.
        const float shifted = std::bit_cast<float>(magnitude) + 0.5f;
        return uint16_t(sign | (std::bit_cast<uint32_t>(shifted) - 0x3f000000u));
    }
    const uint32_t rounded = magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u);
    return uint16_t(sign | (rounded >> 13));
}

} // namespace relief
