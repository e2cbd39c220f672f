#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/cryptomatte.h"
#include "relief/error.h"
#include "relief/image.h"

namespace relief {
namespace {

constexpr int kWidth = 7, kHeight = 5;

/// Radiance of sample k of a pixel: any fixed function will do.
double radiance(int x, int y, int k, int channel) {
    std::mt19937 generator(uint32_t(x + 100 * y + 10000 * k + 1000000 * channel));
    return double(generator()) / 4294967296.0 * (1 + channel);
}

bool is_hit(int x, int y, int k) { return radiance(x, y, k, 5) > 3; }

/// What a render of the window and the sample range [first, last) would give.
Image make_part(std::array<int, 4> window, int first, int last) {
    Image image;
    image.x0 = window[0], image.y0 = window[1];
    image.width = window[2] - window[0], image.height = window[3] - window[1];
    image.full_width = kWidth, image.full_height = kHeight;
    image.channels = {"R",      "G",           "B",          "A",          "depth.Z",   "id.I",
                      "N.X",    "N.Y",         "N.Z",        "P.X",        "samples.Y", "variance.R",
                      "cost.Y", "light_key.R", "N_camera.X", "N_camera.Y", "N_camera.Z"};
    image.metadata = {{"relief:samples", std::to_string(first) + ":" + std::to_string(last)},
                      {"relief:seed", "1"},
                      {"relief:scene_hash", "abcd"}};
    for (int y = window[1]; y < window[3]; ++y)
        for (int x = window[0]; x < window[2]; ++x) {
            const double n = last - first;
            double sums[3] = {}, squares = 0, hits = 0, place = 0, cost = 0;
            float depth = std::numeric_limits<float>::infinity();
            int id = 0;
            for (int k = first; k < last; ++k) {
                for (int c = 0; c < 3; ++c) sums[c] += radiance(x, y, k, c);
                squares += radiance(x, y, k, 0) * radiance(x, y, k, 0);
                cost += 1 + k;
                if (!is_hit(x, y, k)) continue;
                hits += 1, place += radiance(x, y, k, 3);
                const float t = float(radiance(x, y, k, 4));
                if (t < depth) depth = t, id = 1 + k;
            }
            const double mean = sums[0] / n, side = hits > 0 ? 0.6 : 0;
            const double variance = n > 1 ? (squares / n - mean * mean) / (n - 1) : 0;
            for (double value : {mean, sums[1] / n, sums[2] / n, hits / n, double(depth), double(id), side,
                                 0.0, side / 0.75, hits > 0 ? place / hits : 0.0, n, variance, cost / n,
                                 sums[2] / n / 4, side, 0.0, side / 0.75})
                image.pixels.push_back(float(value));
        }
    return image;
}

/// One pixel: hits, then the samples that met a shadow catcher and their light.
Image make_shadow_part(int first, int count, int hits, const std::array<float, 3>& shadow) {
    Image image;
    image.width = image.height = image.full_width = image.full_height = 1;
    image.channels = {"R", "G", "B", "A", "P.X", "shadow.C", "shadow.L", "shadow.U"};
    image.metadata = {{"relief:samples", std::to_string(first) + ":" + std::to_string(first + count)},
                      {"relief:seed", "1"},
                      {"relief:scene_hash", "abcd"}};
    const float n = float(count), alpha = shadow[0] * (1 - shadow[1] / shadow[2]);
    image.pixels = {
        0, 0, 0, (float(hits) + alpha) / n, float(hits), shadow[0] / n, shadow[1] / n, shadow[2] / n};
    return image;
}

TEST(MergeImages, finds_the_alpha_of_shadows_from_the_light_of_all_parts) {
    // Each part by itself says 3/4 and 0; of all light one part in two arrives.
    const std::vector<Image> parts{make_shadow_part(0, 4, 1, {2, 1, 4}),
                                   make_shadow_part(4, 6, 3, {3, 2, 2})};
    const Image merged = merge_images(parts);
    EXPECT_NEAR(merged.pixels[3], (4 + 5 * 0.5) / 10, 1e-6);
    EXPECT_NEAR(merged.pixels[5], 0.5, 1e-6);
    EXPECT_NEAR(merged.pixels[4], (1 * 1 + 3 * 3) / 4.0, 1e-6)
        << "a mean over hits, which shadows are none of";
    EXPECT_EQ(merge_images({parts.data(), 1}).pixels, parts[0].pixels);
}

TEST(MergeImages, joins_tiles_and_sample_ranges_to_the_whole_picture) {
    const Image whole = make_part({0, 0, kWidth, kHeight}, 0, 12);
    const std::vector<Image> parts{make_part({0, 0, 4, kHeight}, 5, 12),
                                   make_part({4, 0, kWidth, kHeight}, 0, 12),
                                   make_part({0, 0, 4, kHeight}, 1, 5), make_part({0, 0, 4, kHeight}, 0, 1)};
    const Image merged = merge_images(parts);
    ASSERT_EQ(merged.channels, whole.channels);
    ASSERT_EQ(merged.pixels.size(), whole.pixels.size());
    EXPECT_EQ(merged.metadata.at("relief:samples"), "0:12");
    EXPECT_EQ(merged.metadata.at("relief:seed"), "1");
    for (size_t i = 0; i < whole.pixels.size(); ++i) {
        const std::string& channel = whole.channels[i % whole.channels.size()];
        if (std::isinf(whole.pixels[i]))
            ASSERT_EQ(merged.pixels[i], whole.pixels[i]) << channel;
        else
            ASSERT_NEAR(merged.pixels[i], whole.pixels[i], 4e-7 * std::fabs(whole.pixels[i]) + 1e-8)
                << channel;
    }
}

TEST(MergeImages, compares_settings_where_parts_say_them) {
    Image a = make_part({0, 0, kWidth, kHeight}, 0, 4), b = make_part({0, 0, kWidth, kHeight}, 4, 8);
    b.metadata["relief:settings"] = "bounces 2";
    EXPECT_NO_THROW(merge_images(std::array{a, b})) << "the part of an older version does not say it";
    a.metadata["relief:settings"] = "bounces 1";
    EXPECT_THROW(merge_images(std::array{a, b}), Error);
}

TEST(MergeImages, keeps_what_parts_say_of_the_whole_picture) {
    Image a = make_part({0, 0, 4, kHeight}, 0, 4), b = make_part({4, 0, kWidth, kHeight}, 0, 4);
    a.metadata["relief:whole_samples"] = "8";
    EXPECT_EQ(merge_images(std::array{b, a}).metadata.at("relief:whole_samples"), "8");
    b.metadata["relief:whole_samples"] = "6";
    EXPECT_FALSE(merge_images(std::array{b, a}).metadata.contains("relief:whole_samples"));
    const std::vector<PictureGap> gaps = find_gaps(std::array{a, b});
    ASSERT_FALSE(gaps.empty());
    EXPECT_EQ(gaps.front().last_sample, 8);
}

TEST(MergeImages, makes_mean_normals_unit_vectors_again) {
    Image a = make_part({0, 0, kWidth, kHeight}, 0, 4), b = make_part({0, 0, kWidth, kHeight}, 4, 8);
    const size_t alpha = 3, normal = a.find_channel("N.X").value();
    a.at(2, 3, alpha) = 0.75f, b.at(2, 3, alpha) = 0.25f; // 3 hits and 1
    a.at(2, 3, normal) = 1, a.at(2, 3, normal + 1) = 0, a.at(2, 3, normal + 2) = 0;
    b.at(2, 3, normal) = 0, b.at(2, 3, normal + 1) = 1, b.at(2, 3, normal + 2) = 0;
    const Image merged = merge_images(std::array{a, b});
    EXPECT_FLOAT_EQ(merged.at(2, 3, normal), 3 / std::sqrt(10.0f));
    EXPECT_FLOAT_EQ(merged.at(2, 3, normal + 1), 1 / std::sqrt(10.0f));
}

TEST(MergeImages, without_depths_takes_the_id_of_the_lowest_range_that_hit) {
    Image a = make_part({0, 0, kWidth, kHeight}, 0, 4), b = make_part({0, 0, kWidth, kHeight}, 4, 8);
    const size_t depth = a.find_channel("depth.Z").value(), id = depth + 1;
    a.channels[depth] = b.channels[depth] = "cost.X";
    a.at(2, 3, id) = 0, b.at(2, 3, id) = 7;
    a.at(1, 3, id) = 5, b.at(1, 3, id) = 2;
    const Image merged = merge_images(std::array{b, a});
    EXPECT_EQ(merged.at(2, 3, id), 7);
    EXPECT_EQ(merged.at(1, 3, id), 5);
}

/// Ranks of one pixel: shares of samples.
Image make_ranks(std::vector<MatteShare> shares, int first, int last, double sample_count) {
    Image image;
    image.width = image.height = image.full_width = image.full_height = 1;
    image.metadata = {{"relief:samples", std::to_string(first) + ":" + std::to_string(last)}};
    image.channels = name_matte_channels(kObjectMattes);
    image.pixels.resize(image.channels.size());
    write_matte_ranks(shares, sample_count, image.pixels.data());
    image.channels.push_back("samples.Y");
    image.pixels.push_back(float(sample_count));
    return image;
}

TEST(MergeImages, adds_what_mattes_have_in_all_parts_and_ranks_them_anew) {
    const Image merged = merge_images(
        std::array{make_ranks({{7, 5}, {4, 3}}, 0, 9, 9), make_ranks({{9, 4}, {4, 3}, {2, 1}}, 9, 25, 16)});
    EXPECT_EQ(merged.pixels, make_ranks({{4, 6}, {7, 5}, {9, 4}, {2, 1}}, 0, 25, 25).pixels);
    const Image many =
        merge_images(std::array{make_ranks({{1, 9}, {2, 8}, {3, 7}, {4, 6}, {5, 5}, {6, 4}}, 0, 64, 64),
                                make_ranks({{11, 3}, {12, 3}, {6, 2}, {14, 9}}, 64, 96, 32)});
    EXPECT_EQ(many.pixels, make_ranks({{1, 9}, {14, 9}, {2, 8}, {3, 7}, {4, 6}, {6, 6}}, 0, 96, 96).pixels);
    const Image alone = make_ranks({{7, 5}, {4, 3}}, 0, 9, 9);
    EXPECT_EQ(merge_images(std::array{alone}).pixels, alone.pixels);
}

TEST(MergeImages, weighs_each_pixel_by_its_own_samples) {
    Image a = make_part({0, 0, kWidth, kHeight}, 0, 4), b = make_part({0, 0, kWidth, kHeight}, 4, 8);
    const size_t red = 0, samples = a.find_channel("samples.Y").value();
    a.at(2, 3, samples) = 1, a.at(2, 3, red) = 10; // stopped early here
    b.at(2, 3, samples) = 4, b.at(2, 3, red) = 20;
    const Image merged = merge_images(std::array{a, b});
    EXPECT_FLOAT_EQ(merged.at(2, 3, red), 18);
    EXPECT_FLOAT_EQ(merged.at(2, 3, samples), 5);
}

TEST(MergeImages, refuses_interrupted_parts_that_do_not_say_how_many_samples_they_have) {
    Image a = make_part({0, 0, 4, kHeight}, 0, 4), b = make_part({0, 0, 4, kHeight}, 4, 8);
    EXPECT_FALSE(merge_images(std::array{a, b}).metadata.contains("relief:interrupted"));
    b.metadata["relief:interrupted"] = "yes";
    EXPECT_TRUE(merge_images(std::array{a, b}).metadata.contains("relief:interrupted"));
    a.channels[10] = b.channels[10] = "other.Y";
    try {
        merge_images(std::array{a, b});
        ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), "part 2");
        EXPECT_NE(std::string(error.what()).find("interrupted"), std::string::npos) << error.what();
    }
    b.metadata.erase("relief:interrupted");
    EXPECT_NO_THROW(merge_images(std::array{a, b}));
}

TEST(MergeImages, keeps_the_bits_of_pixels_that_one_part_covers) {
    const std::vector<Image> parts{make_part({0, 0, 3, kHeight}, 0, 3),
                                   make_part({3, 0, kWidth, kHeight}, 0, 3)};
    EXPECT_EQ(merge_images(parts).pixels, make_part({0, 0, kWidth, kHeight}, 0, 3).pixels);
}

TEST(MergeImages, leaves_holes_black_and_infinitely_far) {
    const Image merged =
        merge_images(std::array{make_part({0, 0, 2, 2}, 0, 1), make_part({5, 3, 7, 5}, 0, 1)});
    EXPECT_EQ(merged.width, 7);
    EXPECT_EQ(merged.at(6, 0, merged.find_channel("samples.Y").value()), 0);
    EXPECT_TRUE(std::isinf(merged.at(6, 0, merged.find_channel("depth.Z").value())));
}

TEST(MergeImages, refuses_overlapping_sample_ranges_of_a_pixel) {
    const Image a = make_part({0, 0, 4, kHeight}, 0, 4);
    EXPECT_THROW(merge_images(std::array{a, a}), Error);
    EXPECT_THROW(merge_images(std::array{a, make_part({3, 0, kWidth, kHeight}, 3, 6)}), Error);
    EXPECT_NO_THROW(merge_images(std::array{a, make_part({4, 0, kWidth, kHeight}, 3, 6)}));
}

TEST(MergeImages, refuses_parts_of_different_pictures) {
    const Image a = make_part({0, 0, 4, kHeight}, 0, 4);
    const auto refuses = [&](auto change) {
        Image b = make_part({0, 0, 4, kHeight}, 4, 8);
        EXPECT_NO_THROW(merge_images(std::array{a, b}));
        change(b);
        try {
            merge_images(std::array{a, b});
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_EQ(error.where(), "part 2");
        }
    };
    refuses([](Image& b) { b.metadata["relief:seed"] = "2"; });
    refuses([](Image& b) { b.metadata["relief:scene_hash"] = "ffff"; });
    refuses([](Image& b) { b.metadata["relief:samples"] = "4-8"; });
    refuses([](Image& b) { b.metadata.erase("relief:samples"); });
    refuses([](Image& b) { b.full_width = 8; });
    refuses([](Image& b) { b.channels[0] = "X"; });
}

} // namespace
} // namespace relief
