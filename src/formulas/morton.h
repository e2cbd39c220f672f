// Morton codes of 30 and 63 bits: x is the most significant of each triple, so bit p belongs to axis 2 - p
// mod 3. All devices and the host round these operations alike.
#ifndef RELIEF_MORTON_H
#define RELIEF_MORTON_H
#include "formulas/begin.h"

const uint kMortonBits30 = 10u; ///< per axis
const uint kMortonBits63 = 21u;

struct MortonCode {
    uint low, high;
};

/// 1 / m for m in [1, 2), to 1e-7, by Newton's iteration: devices may round quotients differently.
FN float invert_mantissa(const float m) {
    EXACT float guess = 1.41176471f - 0.470588235f * m;
    EXACT float first = guess * (2.0f - m * guess);
    EXACT float second = first * (2.0f - m * first);
    EXACT float third = second * (2.0f - m * second);
    return third;
}

/// Cell of `position` in [lower, upper] cut into 2^bits cells; 0 where the interval is empty or a value is
/// NaN. Scaled by a quarter, so that no difference of floats overflows.
FN uint quantise_position(const float position, const float lower, const float upper, const uint bits) {
    EXACT float extent = upper * 0.25f - lower * 0.25f;
    EXACT float offset = position * 0.25f - lower * 0.25f;
    uint exponent = floatBitsToUint(extent) >> 23u; // its highest bit is the sign
    if (exponent == 0u || exponent > 253u) return 0u;
    float to_mantissa = uintBitsToFloat((254u - exponent) << 23u);
    float cells = float(1u << bits);
    EXACT float place = offset * to_mantissa * (cells * invert_mantissa(extent * to_mantissa));
    if (!(place > 0.0f)) return 0u;
    return place < cells ? uint(place) : (1u << bits) - 1u;
}

/// Ten bits, each followed by two zeros.
FN uint spread_bits(uint x) {
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    return (x | (x << 2u)) & 0x09249249u;
}

FN uint interleave_bits(const uint x, const uint y, const uint z) {
    return (spread_bits(x) << 2u) | (spread_bits(y) << 1u) | spread_bits(z);
}

FN Vec3 centre_of_box(const Vec3 lower, const Vec3 upper) {
    EXACT Vec3 centre = lower * 0.5f + upper * 0.5f;
    return centre;
}

/// Code of a point in a box; `high` is 0.
FN MortonCode make_morton30(const Vec3 point, const Vec3 lower, const Vec3 upper) {
    uint x = quantise_position(point.x, lower.x, upper.x, kMortonBits30);
    uint y = quantise_position(point.y, lower.y, upper.y, kMortonBits30);
    uint z = quantise_position(point.z, lower.z, upper.z, kMortonBits30);
    MortonCode code = {interleave_bits(x, y, z), 0u};
    return code;
}

FN MortonCode make_morton63(const Vec3 point, const Vec3 lower, const Vec3 upper) {
    uint x = quantise_position(point.x, lower.x, upper.x, kMortonBits63);
    uint y = quantise_position(point.y, lower.y, upper.y, kMortonBits63);
    uint z = quantise_position(point.z, lower.z, upper.z, kMortonBits63);
    // Bits 0 to 9 of each axis fill 30 bits; bit 10 falls on bits 30, 31 and 32; the others follow.
    uint low = interleave_bits(x & 0x3ffu, y & 0x3ffu, z & 0x3ffu);
    uint high = interleave_bits(x >> 11u, y >> 11u, z >> 11u);
    MortonCode code = {low | (((z >> 10u) & 1u) << 30u) | (((y >> 10u) & 1u) << 31u),
                       (high << 1u) | ((x >> 10u) & 1u)};
    return code;
}

FN uint axis_of_morton_bit(const uint bit) { return 2u - bit % 3u; }

#include "formulas/end.h"
#endif
