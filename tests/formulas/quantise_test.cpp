// Boxes of 16 bits: never smaller than what they hold, hardly larger, the same however they are decoded.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formulas/quantise.h"

namespace relief {

namespace {

class Quantise : public testing::TestWithParam<float> {};

TEST_P(Quantise, keeps_every_value_inside_its_bounds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int round = 0; round < 200; ++round) {
        const float origin = uniform(random) * GetParam(), extent = std::fabs(uniform(random)) * GetParam();
        const float scale = scalar::choose_scale(extent);
        int exponent = 0;
        EXPECT_EQ(std::frexp(scale, &exponent), 0.5f) << "a power of two";
        EXPECT_GE(double(scale) * 65534, double(extent));
        for (int k = 0; k <= 100; ++k) {
            const float value = origin + extent * (float(k) / 100);
            const uint32_t lower = scalar::encode_lower(value, origin, scale);
            const uint32_t upper = scalar::encode_upper(value, origin, scale);
            ASSERT_LE(upper, 65535u);
            EXPECT_LE(scalar::decode_bound(origin, scale, lower), value);
            EXPECT_GE(scalar::decode_bound(origin, scale, upper), value);
            EXPECT_LE(upper - lower, 2u) << value << " in " << origin << " + " << extent;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(sizes, Quantise, testing::Values(1e-20f, 1e-3f, 1.0f, 1e4f, 1e20f));

TEST(quantise, gives_a_plane_its_own_place) {
    const float scale = scalar::choose_scale(0.0f);
    EXPECT_GT(scale, 0.0f);
    EXPECT_EQ(scalar::decode_bound(3.5f, scale, scalar::encode_lower(3.5f, 3.5f, scale)), 3.5f);
    EXPECT_EQ(scalar::decode_bound(3.5f, scale, scalar::encode_upper(3.5f, 3.5f, scale)), 3.5f);
}

TEST(quantise, orders_floats_as_numbers) {
    const float values[] = {-INFINITY, -1e30f, -2.0f, -1e-40f, -0.0f, 0.0f, 1e-40f, 1.0f, 3e38f, INFINITY};
    for (size_t k = 0; k + 1 < std::size(values); ++k)
        EXPECT_LT(scalar::order_float(values[k]), scalar::order_float(values[k + 1]));
    for (const float value : values) EXPECT_EQ(scalar::unorder_float(scalar::order_float(value)), value);
}

} // namespace

} // namespace relief
