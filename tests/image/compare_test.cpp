#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/image.h"

namespace relief {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image make_image(const std::vector<std::string>& channels, const std::vector<float>& pixels) {
    Image image;
    image.width = image.full_width = int(pixels.size() / channels.size());
    image.height = image.full_height = 1;
    image.channels = channels;
    image.pixels = pixels;
    return image;
}

TEST(CompareImages, finds_no_difference_between_equal_images) {
    const Image a = make_image({"R", "G", "B"}, {1, 2, 3, 4, 5, 6});
    const ImageDifference d = compare_images(a, a, "", 0);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_EQ(d.over_threshold, 0u);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.rms, 0);
}

TEST(CompareImages, takes_the_largest_channel_difference_of_each_pixel) {
    const Image a = make_image({"R", "G", "B"}, {1, 2, 3, 4, 5, 6});
    const Image b = make_image({"B", "R", "G"}, {3, 1, 6, 6, 4.5f, 5});
    const ImageDifference d = compare_images(a, b, "", 1);
    EXPECT_EQ(d.over_threshold, 1u);
    EXPECT_DOUBLE_EQ(d.max, 4);
    EXPECT_DOUBLE_EQ(d.mean, 2.25);
    EXPECT_NEAR(d.rms, std::sqrt((16 + 0.25) / 2), 1e-12);
}

TEST(CompareImages, measures_depth_relative_to_the_larger_value) {
    const Image a = make_image({"depth.Z"}, {1, 100, kInfinity, 5, kInfinity});
    const Image b = make_image({"depth.Z"}, {1, 80, kInfinity, kInfinity, 2});
    const ImageDifference d = compare_images(a, b, "depth", 0.1);
    EXPECT_DOUBLE_EQ(d.max, 0.2);
    EXPECT_EQ(d.one_only, 2u);
    EXPECT_EQ(d.over_threshold, 3u);
    EXPECT_DOUBLE_EQ(d.mean, 0.2 / 3);
}

TEST(CompareImages, does_not_confuse_layers_with_a_common_start) {
    const Image a = make_image({"N.X", "Ng.X"}, {1, 5});
    const Image b = make_image({"N.X", "Ng.X"}, {1, 9});
    EXPECT_EQ(compare_images(a, b, "N", 0).max, 0);
    EXPECT_EQ(compare_images(a, b, "Ng", 0).max, 4);
}

TEST(CompareImages, refuses_different_windows_and_missing_layers) {
    const Image a = make_image({"R"}, {1, 2});
    Image b = a;
    b.x0 = 1;
    EXPECT_THROW(compare_images(a, b, "", 0), Error);
    EXPECT_THROW(compare_images(a, make_image({"R"}, {1}), "", 0), Error);
    EXPECT_THROW(compare_images(a, a, "depth", 0), Error);
    EXPECT_THROW(compare_images(a, make_image({"R", "G"}, {1, 2, 3, 4}), "", 0), Error);
    EXPECT_THROW(compare_images(make_image({"R", "G"}, {1, 2, 3, 4}), a, "", 0), Error);
}

} // namespace
} // namespace relief
