#include <limits>

#include <gtest/gtest.h>

#include "formulas/tonemap.h"
#include "statistics.h"

namespace relief {
namespace {

Vec3f map_grey(float x) { return scalar::tone_map_filmic(Vec3f{x, x, x}); }

TEST(ToneMap, rises_from_zero_to_one_and_keeps_middle_grey) {
    EXPECT_EQ(map_grey(0).x, 0);
    float last = 0;
    for (float x = 0.001f; x < 1e4f; x *= 1.1f) {
        const float y = map_grey(x).y;
        ASSERT_GE(y, last);
        ASSERT_LE(y, 1);
        last = y;
    }
    EXPECT_EQ(last, 1);
    for (const float channel : {map_grey(0.18f).x, map_grey(0.18f).y, map_grey(0.18f).z})
        EXPECT_NEAR(channel, 0.18f, 1e-4);
}

TEST(ToneMap, fades_bright_colours_towards_white_and_keeps_dark_ones) {
    const Vec3f dark = scalar::tone_map_filmic(Vec3f{0.1f, 0.01f, 0.01f});
    const Vec3f bright = scalar::tone_map_filmic(Vec3f{100, 1, 1});
    EXPECT_GT(dark.x, 3 * dark.y);
    EXPECT_GT(bright.y, 0.5f);
}

TEST(ToneMap, survives_what_is_no_colour) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(map_grey(-1).x, 0);
    EXPECT_EQ(map_grey(kNan).y, 0);
    EXPECT_EQ(map_grey(kInfinite).z, 1);
    EXPECT_LT(scalar::tone_map_filmic(Vec3f{kNan, 0.18f, 0.18f}).x, 0.18f);
}

TEST(ToneMap, encodes_srgb_and_decodes_it_again) {
    for (int k = 0; k <= 255; ++k) {
        const float x = float(k) / 255;
        ASSERT_NEAR(scalar::encode_srgb(scalar::decode_srgb(x)), x, 2e-6);
    }
    EXPECT_NEAR(scalar::encode_srgb(0.214041f), 0.5f, 1e-5);
}

} // namespace
} // namespace relief
