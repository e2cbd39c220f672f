#include "surface/map/texel_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/strides.h"
#include "support/targets.h"
#include "surface/map/texels.h"

namespace relief {
namespace {

constexpr uint32_t kWidth = 37, kHeight = 23;

enum class Coding { floats, halves };

/// Every finite half can come up, zeros of both signs and denormals among them.
Texture make_noise(Coding coding) {
    std::mt19937 random(3);
    Texture texture;
    texture.width = kWidth, texture.height = kHeight;
    for (uint32_t k = 0; k < 4 * kWidth * kHeight; ++k) {
        uint16_t half = uint16_t(random());
        if ((half & 0x7c00) == 0x7c00) half = random() % 2 != 0 ? 0 : 0x8000;
        if (coding == Coding::halves)
            texture.halves.push_back(half);
        else
            texture.floats.push_back(half_to_float(half));
    }
    return texture;
}

ChannelRange find_one_by_one(const Texture& texture, const TexelRectangle& rectangle) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ChannelRange range{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (uint32_t y = rectangle.y0; y <= rectangle.y1; ++y)
        for (uint32_t x = rectangle.x0; x <= rectangle.x1; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const float value = read_texel(texture, x, y)[c];
                range.low[c] = std::min(range.low[c], value), range.high[c] = std::max(range.high[c], value);
            }
    return range;
}

void expect_ranges_of_texels() {
    std::mt19937 random(4);
    for (const Coding coding : {Coding::floats, Coding::halves}) {
        for (const uint32_t stride : {4u, 3u, 1u}) {
            const Texture noise = make_noise(coding),
                          texture = stride == 4 ? noise : test::make_narrow(noise, stride);
            for (int k = 0; k < 2000; ++k) {
                const uint32_t x0 = random() % kWidth, y0 = random() % kHeight;
                const TexelRectangle rectangle{x0, y0, x0 + uint32_t(random()) % (kWidth - x0),
                                               y0 + uint32_t(random()) % (kHeight - y0)};
                const std::optional<ChannelRange> found = find_texel_range(texture, rectangle);
                const ChannelRange expected = find_one_by_one(texture, rectangle);
                ASSERT_TRUE(found);
                for (size_t c = 0; c < 3; ++c) {
                    EXPECT_EQ(found->low[c], expected.low[c]) << k;
                    EXPECT_EQ(found->high[c], expected.high[c]) << k;
                }
            }
        }
    }
}

void expect_nothing_where_a_channel_is_not_finite() {
    const TexelRectangle all{0, 0, kWidth - 1, kHeight - 1};
    for (const uint16_t bits : {0x7c00, 0xfc00, 0x7e00, 0xfe00, 0x7c01, 0xffff})
        for (const uint32_t texel : {0u, 36u, 37u, 500u, kWidth * kHeight - 1})
            for (const uint32_t channel : {0u, 1u, 2u, 3u}) {
                Texture halves = make_noise(Coding::halves), floats = make_noise(Coding::floats);
                halves.halves[4 * texel + channel] = bits;
                floats.floats[4 * texel + channel] = half_to_float(bits);
                EXPECT_EQ(find_texel_range(halves, all).has_value(), channel == 3) << bits << " at " << texel;
                EXPECT_EQ(find_texel_range(floats, all).has_value(), channel == 3) << bits << " at " << texel;
                for (const uint32_t stride : {3u, 1u})
                    for (const Texture* wide : {&halves, &floats})
                        EXPECT_EQ(find_texel_range(test::make_narrow(*wide, stride), all).has_value(),
                                  channel >= stride);
            }
}

TEST(TexelRange, is_that_of_the_texels_one_by_one) { test::check_on_every_target(expect_ranges_of_texels); }

TEST(TexelRange, is_nothing_where_a_channel_is_not_finite) {
    test::check_on_every_target(expect_nothing_where_a_channel_is_not_finite);
}

} // namespace
} // namespace relief
