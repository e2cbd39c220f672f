// Which part of a picture is as good as was asked for.
#include "engine/block_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief {

namespace {

/// Four columns of blocks, each of 160 pixels, whose noise rises from 0 to the right.
Film make_rising_film(int samples) {
    const Window window{0, 0, 32, 20};
    Film film(32, 20, window, {}, ErrorEstimate::on);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (int k = 0; k < samples; ++k) {
                FilmSample sample;
                const float value = 1 + 0.2f * float(x / 8) * (k % 2 == 0 ? 1.0f : -1.0f);
                sample.radiance = {value, value, value};
                film.add_sample(x, y, sample);
            }
    return film;
}

} // namespace

TEST(BlockNoise, counts_the_pixels_that_reached_it_and_says_what_others_have) {
    const Film film = make_rising_film(16);
    const double third = estimate_block_noise(film, {16, 0, 24, 8});
    const double fourth = estimate_block_noise(film, {24, 0, 32, 8});
    EXPECT_GT(fourth, 1.4 * third);
    const NoiseReport some = measure_noise(film, 0.5 * (third + estimate_block_noise(film, {8, 0, 16, 8})));
    EXPECT_EQ(some.pixels, 640u);
    EXPECT_EQ(some.reached_pixels, 320u);
    EXPECT_NEAR(some.most, fourth, 1e-6);
    EXPECT_NEAR(some.median, third, 1e-6) << "the better half of the other 320";
    const NoiseReport one = measure_noise(film, 0.5 * (third + fourth));
    EXPECT_EQ(one.reached_pixels, 480u);
    EXPECT_NEAR(one.median, fourth, 1e-6);
    const NoiseReport all = measure_noise(film, 1);
    EXPECT_EQ(all.reached_pixels, all.pixels);
    EXPECT_EQ(all.most, 0);
}

TEST(BlockNoise, of_a_single_sample_is_not_known) {
    const NoiseReport report = measure_noise(make_rising_film(1), 1);
    EXPECT_EQ(report.reached_pixels, 0u);
    EXPECT_TRUE(std::isinf(report.most) && std::isinf(report.median));
}

} // namespace relief
