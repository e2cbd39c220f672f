// What parts leave out of their picture.
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/image.h"

namespace relief {
namespace {

constexpr int kPartWidth = 8, kPartHeight = 6;

Image make_plain_part(std::array<int, 4> window, int first, int last) {
    Image image;
    image.x0 = window[0], image.y0 = window[1];
    image.width = window[2] - window[0], image.height = window[3] - window[1];
    image.full_width = kPartWidth, image.full_height = kPartHeight;
    image.channels = {"R", "samples.Y"};
    image.metadata["relief:samples"] = std::to_string(first) + ":" + std::to_string(last);
    for (int k = 0; k < image.width * image.height; ++k)
        image.pixels.insert(image.pixels.end(), {0.5f, float(last - first)});
    return image;
}

using Parts = std::vector<Image>;
using Gaps = std::vector<PictureGap>;

TEST(FindGaps, finds_none_in_tiles_and_ranges_that_make_the_whole) {
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 6}, 0, 4)}), Gaps{});
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 3, 8, 6}, 0, 4), make_plain_part({0, 0, 8, 3}, 2, 4),
                              make_plain_part({0, 0, 8, 3}, 0, 2)}),
              Gaps{});
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 4, 3}, 0, 4), make_plain_part({4, 0, 8, 2}, 0, 4),
                              make_plain_part({4, 2, 8, 6}, 0, 4), make_plain_part({0, 3, 4, 6}, 0, 4)}),
              Gaps{});
    EXPECT_EQ(find_gaps(Parts{}), Gaps{});
}

TEST(FindGaps, one_window_of_all_parts_is_a_crop_and_whole) {
    EXPECT_EQ(find_gaps(Parts{make_plain_part({2, 1, 5, 4}, 0, 2), make_plain_part({2, 1, 5, 4}, 2, 8)}),
              Gaps{});
}

TEST(FindGaps, names_rows_and_windows_of_the_display_window) {
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 2}, 0, 4), make_plain_part({0, 3, 8, 5}, 0, 4)}),
              (Gaps{{0, 2, 8, 3, 0, 4}, {0, 5, 8, 6, 0, 4}}));
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 2}, 0, 4), make_plain_part({0, 2, 3, 6}, 0, 4)}),
              (Gaps{{3, 2, 8, 6, 0, 4}}));
    // Three bands beside the gap, which is one window all the same.
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 3, 2}, 0, 4), make_plain_part({0, 2, 3, 3}, 0, 4),
                              make_plain_part({0, 3, 3, 6}, 0, 4)}),
              (Gaps{{3, 0, 8, 6, 0, 4}}));
}

TEST(FindGaps, names_ranges_of_samples_from_the_first) {
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 6}, 0, 2), make_plain_part({0, 0, 8, 6}, 4, 8),
                              make_plain_part({0, 0, 8, 6}, 9, 10)}),
              (Gaps{{0, 0, 8, 6, 2, 4}, {0, 0, 8, 6, 8, 9}}));
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 6}, 4, 8)}), (Gaps{{0, 0, 8, 6, 0, 4}}));
    EXPECT_EQ(find_gaps(Parts{make_plain_part({0, 0, 8, 3}, 0, 8), make_plain_part({0, 3, 8, 6}, 0, 4)}),
              (Gaps{{0, 3, 8, 6, 4, 8}}));
}

TEST(FindGaps, an_interrupted_part_has_the_samples_of_its_least_pixel) {
    Image part = make_plain_part({0, 0, 8, 6}, 0, 8);
    part.at(3, 2, 1) = 5;
    EXPECT_EQ(find_gaps(Parts{part}), (Gaps{{0, 0, 8, 6, 5, 8}}));
    part.at(3, 2, 1) = 0;
    EXPECT_EQ(find_gaps(Parts{part}), (Gaps{{0, 0, 8, 6, 0, 8}}));
}

TEST(FindGaps, samples_that_low_noise_spared_are_not_missing) {
    Image upper = make_plain_part({0, 0, 8, 3}, 0, 64), lower = make_plain_part({0, 3, 8, 6}, 0, 64);
    upper.metadata["relief:noise"] = lower.metadata["relief:noise"] = "0.02";
    upper.at(3, 2, 1) = 16;
    EXPECT_EQ(find_gaps(Parts{upper, lower}), Gaps{});
    for (const char* key : {"relief:interrupted", "relief:time_limit"}) {
        Image ended = upper;
        ended.metadata[key] = "yes";
        EXPECT_EQ(find_gaps(Parts{ended, lower}), (Gaps{{0, 0, 8, 3, 16, 64}})) << key;
    }
}

TEST(FindGaps, refuses_parts_without_a_range) {
    Image part = make_plain_part({0, 0, 8, 6}, 0, 8);
    for (const char* range : {"", "8", "4:4", "-1:3", "a:b", "1:2x"}) {
        part.metadata["relief:samples"] = range;
        EXPECT_THROW(find_gaps(Parts{part}), Error) << range;
    }
}

} // namespace
} // namespace relief
