// Raw texels by integer coordinates: half to float, the wrap modes, four channels to three.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "relief/scene.h"

namespace relief {

/// Exact value of an IEEE 754 binary16 pattern.
inline float half_to_float(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000u) << 16;
    const uint32_t exponent = (half >> 10) & 31u;
    const uint32_t mantissa = half & 1023u;
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
    if (exponent != 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
    const float magnitude = float(mantissa) * 0x1p-24f;
    return sign ? -magnitude : magnitude;
}

/// Column or row that `index` reads in a map of `size` texels; -1 outside of WrapMode::black.
inline int64_t wrap_index(int64_t index, int64_t size, WrapMode wrap) {
    switch (wrap) {
    case WrapMode::clamp:
        return index < 0 ? 0 : index >= size ? size - 1 : index;
    case WrapMode::repeat: {
        const int64_t rest = index % size;
        return rest < 0 ? rest + size : rest;
    }
    case WrapMode::mirror: {
        int64_t rest = index % (2 * size);
        if (rest < 0) rest += 2 * size;
        return rest < size ? rest : 2 * size - 1 - rest;
    }
    case WrapMode::black:
        break;
    }
    return index < 0 || index >= size ? -1 : index;
}

/// First three channels of the texel in column x and row y, both inside the texture.
inline std::array<float, 3> read_texel(const Texture& texture, int64_t x, int64_t y) {
    const size_t offset = 4 * (size_t(y) * texture.width + size_t(x));
    if (texture.halves.empty())
        return {texture.floats[offset], texture.floats[offset + 1], texture.floats[offset + 2]};
    return {half_to_float(texture.halves[offset]), half_to_float(texture.halves[offset + 1]),
            half_to_float(texture.halves[offset + 2])};
}

} // namespace relief
