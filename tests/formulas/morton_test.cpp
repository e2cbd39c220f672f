#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "formulas/morton.h"

namespace relief {
namespace {

using namespace scalar;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kGreatest = std::numeric_limits<float>::max();

/// Bit by bit.
uint64_t interleave_slowly(uint32_t x, uint32_t y, uint32_t z, int bits) {
    uint64_t code = 0;
    for (int k = bits - 1; k >= 0; --k)
        for (const uint32_t axis : {x, y, z}) code = code << 1 | ((axis >> k) & 1u);
    return code;
}

uint64_t to_bits(const MortonCode& code) { return uint64_t(code.high) << 32 | code.low; }

TEST(Morton, codes_have_x_in_the_most_significant_bit_of_each_triple) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-3, 5);
    const Vec3f lower{-3, -3, -3}, upper{5, 5, 5};
    for (int k = 0; k < 20000; ++k) {
        const Vec3f p{unit(random), unit(random), unit(random)};
        const auto cell = [&](float a, uint32_t bits) { return quantise_position(a, -3, 5, bits); };
        EXPECT_EQ(to_bits(make_morton30(p, lower, upper)),
                  interleave_slowly(cell(p.x, 10), cell(p.y, 10), cell(p.z, 10), 10));
        EXPECT_EQ(to_bits(make_morton63(p, lower, upper)),
                  interleave_slowly(cell(p.x, 21), cell(p.y, 21), cell(p.z, 21), 21));
    }
    EXPECT_EQ(axis_of_morton_bit(62), 0u);
    EXPECT_EQ(axis_of_morton_bit(29), 0u);
    EXPECT_EQ(axis_of_morton_bit(1), 1u);
    EXPECT_EQ(axis_of_morton_bit(0), 2u);
}

TEST(Morton, cells_are_in_order_and_use_the_whole_range) {
    std::mt19937 random(2);
    for (const float scale : {1e-30f, 1e-3f, 1.0f, 777.0f, 1e30f})
        for (const uint32_t bits : {10u, 21u}) {
            std::uniform_real_distribution<float> unit(-0.3f, 1);
            const float lower = -0.3f * scale, upper = scale;
            EXPECT_EQ(quantise_position(lower, lower, upper, bits), 0u);
            EXPECT_EQ(quantise_position(upper, lower, upper, bits), (1u << bits) - 1u);
            for (int k = 0; k < 2000; ++k) {
                const float a = unit(random) * scale, b = unit(random) * scale;
                const uint32_t cell_a = quantise_position(a, lower, upper, bits);
                const uint32_t cell_b = quantise_position(b, lower, upper, bits);
                if (a <= b) EXPECT_LE(cell_a, cell_b);
                const double exact = (double(a) - lower) / (double(upper) - lower) * double(1u << bits);
                EXPECT_NEAR(double(cell_a), std::floor(exact), bits == 10 ? 1.0 : 2.0);
            }
        }
}

TEST(Morton, cells_are_found_whatever_the_numbers_are) {
    const float strange[] = {-kInfinity,
                             -kGreatest,
                             -1,
                             -1e-45f,
                             0,
                             1e-45f,
                             1e-38f,
                             1,
                             kGreatest,
                             kInfinity,
                             std::numeric_limits<float>::quiet_NaN()};
    for (const float position : strange)
        for (const float lower : strange)
            for (const float upper : strange)
                for (const uint32_t bits : {10u, 21u})
                    EXPECT_LT(quantise_position(position, lower, upper, bits), 1u << bits);
    EXPECT_EQ(quantise_position(3, 3, 3, 10), 0u);
    EXPECT_EQ(quantise_position(kGreatest, -kGreatest, kGreatest, 10), 1023u);
    EXPECT_NEAR(quantise_position(0, -kGreatest, kGreatest, 10), 512, 1);
}

TEST(Morton, inverse_of_a_mantissa_is_good_to_a_ten_millionth) {
    for (float m = 1; m < 2; m += 1e-4f) EXPECT_NEAR(invert_mantissa(m) * m, 1, 2.5e-7f) << m;
}

} // namespace
} // namespace relief
