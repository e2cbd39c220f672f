#include "bench/error_curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "relief/error.h"

namespace relief::bench {
namespace {

Image make_picture(float value) {
    Image image;
    image.width = 2, image.height = 1;
    image.channels = {"R", "G", "B"};
    image.pixels.assign(6, value);
    return image;
}

TEST(RelativeError, is_relative_to_the_reference) {
    EXPECT_EQ(compute_relative_error(make_picture(2), make_picture(2)), 0);
    EXPECT_NEAR(compute_relative_error(make_picture(3), make_picture(2)), 1 / 4.01, 1e-12);
    EXPECT_NEAR(compute_relative_error(make_picture(0.5f), make_picture(0)), 0.25 / 0.01, 1e-9);
    Image one = make_picture(2);
    one.pixels[0] = 3;
    EXPECT_NEAR(compute_relative_error(one, make_picture(2)), 1 / 4.01 / 6, 1e-12);
}

TEST(RelativeError, refuses_pictures_that_it_cannot_hold_against_each_other) {
    Image other = make_picture(1);
    other.channels[2] = "Z";
    EXPECT_THROW(compute_relative_error(other, make_picture(1)), Error);
    Image small = make_picture(1);
    small.width = 1, small.pixels.resize(3);
    EXPECT_THROW(compute_relative_error(small, make_picture(1)), Error);
}

TEST(ErrorCurve, interpolates_in_logarithms) {
    const ErrorPoint curve[] = {{1, 0.5, 0.4}, {4, 2, 0.1}, {16, 8, 0.025}};
    EXPECT_NEAR(find_seconds(curve, 0.2).value(), 1, 1e-9); // halfway: error and time are inverse here
    EXPECT_NEAR(find_seconds(curve, 0.05).value(), 4, 1e-9);
    EXPECT_EQ(find_seconds(curve, 0.1).value(), 2);
}

TEST(ErrorCurve, ends_where_pictures_end) {
    const ErrorPoint curve[] = {{1, 0.5, 0.4}, {4, 2, 0.1}};
    EXPECT_EQ(find_seconds(curve, 3).value(), 0.5);
    EXPECT_FALSE(find_seconds(curve, 0.05));
    EXPECT_FALSE(find_seconds({}, 0.05));
}

} // namespace
} // namespace relief::bench
