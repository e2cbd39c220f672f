#include <limits>

#include <gtest/gtest.h>

#include "statistics.h"

namespace relief {
namespace {

TEST(ToneMap, rises_from_zero_to_one_and_keeps_middle_grey) {
    EXPECT_EQ(scalar::tone_map_filmic(0), 0);
    EXPECT_NEAR(scalar::tone_map_filmic(0.18f), 0.18f, 1e-4);
    float last = 0;
    for (float x = 0.001f; x < 1e4f; x *= 1.1f) {
        const float y = scalar::tone_map_filmic(x);
        ASSERT_GE(y, last);
        ASSERT_LE(y, 1);
        last = y;
    }
    EXPECT_EQ(last, 1);
}

TEST(ToneMap, survives_what_is_no_colour) {
    EXPECT_EQ(scalar::tone_map_filmic(-1), 0);
    EXPECT_EQ(scalar::tone_map_filmic(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(scalar::tone_map_filmic(std::numeric_limits<float>::infinity()), 1);
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
