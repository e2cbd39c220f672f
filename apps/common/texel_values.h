// Texels of displacement maps as numbers: read, written, decoded and encoded.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "relief/image.h"
#include "relief/scene.h"

namespace relief {

/// IEEE 754 binary16 to float, exact.
inline float widen_half(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000u) << 16;
    const uint32_t magnitude = uint32_t(half & 0x7fffu) << 13;
    // 2^112 moves the exponent's bias from 15 to 127, and the product makes subnormals normal.
    const float scaled = std::bit_cast<float>(magnitude) * std::bit_cast<float>(0x77800000u);
    const bool is_special = (half & 0x7c00u) == 0x7c00u;
    return std::bit_cast<float>(sign |
                                (is_special ? magnitude | 0x7f800000u : std::bit_cast<uint32_t>(scaled)));
}

/// A finite value to the nearest half, ties to even; what is out of range becomes the largest one.
inline uint16_t round_to_half(float value) {
    const uint32_t bits = std::bit_cast<uint32_t>(value), sign = (bits >> 16) & 0x8000u;
    const uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude >= 0x477fe000u) return uint16_t(sign | 0x7bffu);
    if (magnitude < 0x38800000u) {
        // Below the normal halves the sum with 0.5 rounds to multiples of 2^-24, their spacing.
        const float shifted = std::bit_cast<float>(magnitude) + 0.5f;
        return uint16_t(sign | (std::bit_cast<uint32_t>(shifted) - 0x3f000000u));
    }
    return uint16_t(sign | ((magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u)) >> 13));
}

/// The first three channels of a texel inside of the map.
inline Vec3f read_texel(const Texture& texture, uint32_t x, uint32_t y) {
    const size_t at = 4 * (size_t(y) * texture.width + x);
    if (texture.halves.empty()) return {texture.floats[at], texture.floats[at + 1], texture.floats[at + 2]};
    return {widen_half(texture.halves[at]), widen_half(texture.halves[at + 1]),
            widen_half(texture.halves[at + 2])};
}

/// Its inverse, rounded where the map holds halves. The value is finite.
inline void write_texel(Texture& texture, uint32_t x, uint32_t y, const Vec3f& value) {
    const size_t at = 4 * (size_t(y) * texture.width + x);
    const float values[] = {value.x, value.y, value.z};
    for (size_t c = 0; c < 3; ++c) {
        if (texture.halves.empty())
            texture.floats[at + c] = values[c];
        else
            texture.halves[at + c] = round_to_half(values[c]);
    }
}

/// Displacement that a value means, along t, b, n or x, y, z; of a height map along n.
inline Vec3f decode_texel(const Displacement& map, const Vec3f& value) {
    const float decoded[] = {(value.x - map.midlevel.x) * map.scale.x,
                             (value.y - map.midlevel.y) * map.scale.y,
                             (value.z - map.midlevel.z) * map.scale.z};
    if (map.type == DisplacementType::height) return {0, 0, decoded[0]};
    float along[3] = {};
    for (size_t c = 0; c < 3; ++c) along[map.axes.axis[c]] = decoded[c] * float(map.axes.sign[c]);
    return {along[0], along[1], along[2]};
}

/// What a further displacement adds to a value. Channels that mean nothing, for a scale of 0 or beyond the
/// first of a height map, get nothing.
inline Vec3f encode_step(const Displacement& map, const Vec3f& displacement) {
    const auto encode = [](float decoded, float scale) { return scale == 0 ? 0 : decoded / scale; };
    if (map.type == DisplacementType::height) return {encode(displacement.z, map.scale.x), 0, 0};
    const float along[] = {displacement.x, displacement.y, displacement.z};
    const auto signed_along = [&](size_t c) { return along[map.axes.axis[c]] * float(map.axes.sign[c]); };
    return {encode(signed_along(0), map.scale.x), encode(signed_along(1), map.scale.y),
            encode(signed_along(2), map.scale.z)};
}

} // namespace relief
