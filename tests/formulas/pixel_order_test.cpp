// The order in which a device takes pixels: every pixel once, squares together.
#include <gtest/gtest.h>

#include <vector>

#include "formulas/pixel_order.h"

namespace relief {

namespace {

TEST(pixel_order, takes_every_pixel_of_any_window_once) {
    for (const uint32_t width : {1u, 7u, 8u, 9u, 33u})
        for (const uint32_t height : {1u, 5u, 8u, 17u, 24u}) {
            std::vector<int> seen(width * height, 0);
            for (uint32_t k = 0; k < width * height; ++k) {
                const scalar::PixelPlace pixel = scalar::place_pixel(k, width, height);
                ASSERT_LT(pixel.x, width);
                ASSERT_LT(pixel.y, height);
                ++seen[pixel.y * width + pixel.x];
                ASSERT_EQ(scalar::find_pixel_number(pixel.x, pixel.y, width, height), k);
            }
            for (const int count : seen) ASSERT_EQ(count, 1) << width << " x " << height;
        }
}

TEST(pixel_order, keeps_the_pixels_of_a_square_together) {
    for (uint32_t k = 0; k < 64; ++k) {
        const scalar::PixelPlace pixel = scalar::place_pixel(64 * 5 + k, 80, 80);
        EXPECT_EQ(pixel.x / 8, 5u);
        EXPECT_EQ(pixel.y / 8, 0u);
    }
}

} // namespace

} // namespace relief
