#include "farm/preview.h"

#include <gtest/gtest.h>

namespace relief::cli {
namespace {

Image make_band(int y0, int y1) {
    Image band;
    band.full_width = 10, band.full_height = 9, band.width = 10, band.height = y1 - y0, band.y0 = y0;
    band.channels = {"R", "G", "B", "A"};
    for (int y = y0; y < y1; ++y)
        for (int x = 0; x < 10; ++x) band.pixels.insert(band.pixels.end(), {float(x), float(y), 1, 1});
    return band;
}

TEST(FarmPreview, bands_of_a_frame_have_rows_of_their_own) {
    int rows = 0;
    for (const auto& [y0, y1] : {std::pair(0, 4), std::pair(4, 5), std::pair(5, 9)}) {
        const Image preview = make_preview(make_band(y0, y1), 4);
        EXPECT_EQ(preview.full_width, 3);
        EXPECT_EQ(preview.full_height, 3);
        EXPECT_EQ(preview.width, 3);
        EXPECT_EQ(preview.y0, rows);
        rows += preview.height;
    }
    EXPECT_EQ(rows, 3);
}

TEST(FarmPreview, a_pixel_is_the_mean_of_those_of_its_part) {
    const Image preview = make_preview(make_band(4, 9), 4);
    ASSERT_EQ(preview.height, 2);
    EXPECT_FLOAT_EQ(preview.at(0, 1, 0), 1.5f); // columns 0 to 3
    EXPECT_FLOAT_EQ(preview.at(0, 1, 1), 5.5f); // rows 4 to 7
    EXPECT_FLOAT_EQ(preview.at(2, 2, 0), 8.5f); // columns 8 and 9
    EXPECT_FLOAT_EQ(preview.at(2, 2, 1), 8);    // row 8
}

} // namespace
} // namespace relief::cli
