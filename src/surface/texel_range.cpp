#include "surface/texel_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "math/half.h"
#include "relief/error.h"
#include "surface/texels.h"

namespace relief {

namespace {

constexpr size_t kWide = 16; ///< four texels at a time, in loops that compilers turn into vector instructions

/// Orders the bits of halves as their values are; the map is its own inverse.
int16_t make_key(uint16_t half) { return int16_t(half ^ ((half & 0x8000u) != 0 ? 0x7fffu : 0u)); }

constexpr int16_t kInfinityKey = 0x7c00, kMinusInfinityKey = int16_t(0xfc00u ^ 0x7fffu);

/// Halves as keys: least and greatest of every channel of four texels.
struct HalfRange {
    using Value = uint16_t;
    int16_t low[kWide], high[kWide];

    HalfRange() {
        std::fill(low, low + kWide, std::numeric_limits<int16_t>::max());
        std::fill(high, high + kWide, std::numeric_limits<int16_t>::min());
    }
    void extend(const uint16_t* values, size_t count) {
        for (size_t k = 0; k < count; ++k) {
            const int16_t key = make_key(values[k]);
            low[k] = std::min(low[k], key), high[k] = std::max(high[k], key);
        }
    }
    bool is_finite(size_t k) const {
        return low[k] > high[k] || (low[k] > kMinusInfinityKey && high[k] < kInfinityKey);
    }
    bool is_empty(size_t k) const { return low[k] > high[k]; }
    float get_low(size_t k) const { return half_to_float(uint16_t(make_key(uint16_t(low[k])))); }
    float get_high(size_t k) const { return half_to_float(uint16_t(make_key(uint16_t(high[k])))); }
};

struct FloatRange {
    using Value = float;
    float low[kWide], high[kWide], doubt[kWide]; ///< doubt: 0, or NaN after NaN or infinity

    FloatRange() {
        std::fill(low, low + kWide, std::numeric_limits<float>::infinity());
        std::fill(high, high + kWide, -std::numeric_limits<float>::infinity());
        std::fill(doubt, doubt + kWide, 0.0f);
    }
    void extend(const float* values, size_t count) {
        for (size_t k = 0; k < count; ++k) {
            low[k] = values[k] < low[k] ? values[k] : low[k];
            high[k] = values[k] > high[k] ? values[k] : high[k];
            doubt[k] += values[k] - values[k];
        }
    }
    bool is_finite(size_t k) const { return doubt[k] == 0; }
    bool is_empty(size_t k) const { return low[k] > high[k]; }
    float get_low(size_t k) const { return low[k]; }
    float get_high(size_t k) const { return high[k]; }
};

template <class Range>
std::optional<ChannelRange> find_range(const typename Range::Value* values, uint32_t width,
                                       const TexelRectangle& rectangle) {
    Range range;
    const size_t count = 4 * (size_t(rectangle.x1) - rectangle.x0 + 1);
    for (size_t y = rectangle.y0; y <= rectangle.y1; ++y) {
        const typename Range::Value* row = values + 4 * (y * width + rectangle.x0);
        size_t k = 0;
        for (; k + kWide <= count; k += kWide) range.extend(row + k, kWide);
        range.extend(row + k, count - k);
    }
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ChannelRange result{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (size_t k = 0; k < kWide; ++k) {
        if (k % 4 == 3) continue;
        if (!range.is_finite(k)) return std::nullopt;
        if (range.is_empty(k)) continue;
        result.low[k % 4] = std::min(result.low[k % 4], range.get_low(k));
        result.high[k % 4] = std::max(result.high[k % 4], range.get_high(k));
    }
    return result;
}

} // namespace

std::optional<ChannelRange> find_texel_range(const Texture& texture, const TexelRectangle& rectangle) {
    return texture.halves.empty() ? find_range<FloatRange>(texture.floats.data(), texture.width, rectangle)
                                  : find_range<HalfRange>(texture.halves.data(), texture.width, rectangle);
}

void refuse_bad_texel(const Texture& texture, const TexelRectangle& rectangle) {
    for (uint32_t y = rectangle.y0; y <= rectangle.y1; ++y)
        for (uint32_t x = rectangle.x0; x <= rectangle.x1; ++x) {
            const std::array<float, 3> texel = read_texel(texture, x, y);
            for (int c = 0; c < 3; ++c)
                if (!std::isfinite(texel[c]))
                    throw Error(ErrorKind::bad_input,
                                {fmt::format("map holds {} in channel {}",
                                             std::isnan(texel[c]) ? "NaN" : "infinity", c),
                                 fmt::format("{}, pixel ({}, {})", texture.file, x, y), "repair the map"});
        }
    throw Error(ErrorKind::bad_input, {"map holds NaN or infinity", texture.file, "repair the map"});
}

} // namespace relief
