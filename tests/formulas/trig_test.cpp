#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "formulas/constants.h"
#include "formulas/trig.h"

namespace relief {
namespace {

TEST(Trig, gives_sine_and_cosine_to_the_last_bits_of_a_float) {
    for (int k = -400000; k <= 400000; ++k) {
        const float angle =
            float(k) * (k % 2 == 0 ? 3.2e-5f : 5e-3f); // two turns each way, and three hundred
        const scalar::SinCos at = scalar::find_sin_cos(angle);
        ASSERT_NEAR(at.sine, std::sin(double(angle)), 1e-7) << angle;
        ASSERT_NEAR(at.cosine, std::cos(double(angle)), 1e-7) << angle;
    }
    EXPECT_EQ(scalar::find_sin_cos(0).sine, 0);
    EXPECT_EQ(scalar::find_sin_cos(0).cosine, 1);
}

TEST(Trig, finds_the_angle_of_a_point_in_every_octant) {
    for (int k = -100000; k < 100000; ++k) {
        const double angle = (k + 0.5) * 1e-5 * std::numbers::pi;
        const float x = float(3 * std::cos(angle)), y = float(3 * std::sin(angle));
        ASSERT_NEAR(scalar::find_angle(y, x), std::atan2(double(y), double(x)), 4e-7) << angle;
    }
    EXPECT_EQ(scalar::find_angle(0, 0), 0);
    EXPECT_FLOAT_EQ(scalar::find_angle(0, -2), scalar::kPi);
    EXPECT_FLOAT_EQ(scalar::find_angle(1, 0), 0.5f * scalar::kPi);
    EXPECT_FLOAT_EQ(scalar::find_angle(-1, 0), -0.5f * scalar::kPi);
    EXPECT_FLOAT_EQ(scalar::find_angle(-1e-30f, 1e-30f), -0.25f * scalar::kPi);
}

TEST(Trig, finds_the_angle_of_a_cosine_up_to_the_ends) {
    for (int k = -100000; k <= 100000; ++k) {
        const float cosine = float(k) * 1e-5f;
        if (std::fabs(cosine) > 1) continue;
        ASSERT_NEAR(scalar::find_arc_cosine(cosine), std::acos(double(cosine)), 4e-7) << cosine;
    }
    EXPECT_EQ(scalar::find_arc_cosine(1), 0);
    EXPECT_FLOAT_EQ(scalar::find_arc_cosine(-1), scalar::kPi);
}

} // namespace
} // namespace relief
