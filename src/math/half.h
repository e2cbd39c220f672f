// IEEE 754 binary16 bits to float, exactly.
#pragma once

#include <bit>
#include <cstdint>

namespace relief {

inline float half_to_float(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000u) << 16;
    const uint32_t exponent_and_mantissa = uint32_t(half & 0x7fffu) << 13;
    // 2^112 moves the exponent's bias from 15 to 127 and makes subnormals normal by the multiplication
    // itself.
    const float scaled = std::bit_cast<float>(exponent_and_mantissa) * std::bit_cast<float>(0x77800000u);
    const uint32_t special = (half & 0x7c00u) == 0x7c00u ? exponent_and_mantissa | 0x7f800000u : 0u;
    return std::bit_cast<float>(sign | (special != 0 ? special : std::bit_cast<uint32_t>(scaled)));
}

} // namespace relief
