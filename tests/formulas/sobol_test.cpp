#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "formulas/sobol.h"
#include "statistics.h"

namespace relief {
namespace {

using scalar::sobol_pair;

TEST(Sobol, puts_one_point_into_every_elementary_interval_of_every_power_of_two) {
    for (uint32_t pair : {0u, 5u, 40u})
        for (uint32_t m : {4u, 8u})
            for (uint32_t block : {0u, 3u}) {
                const uint32_t count = 1u << m;
                for (uint32_t bits_x = 0; bits_x <= m; ++bits_x) {
                    std::vector<int> cells(count);
                    for (uint32_t k = 0; k < count; ++k) {
                        const Vec2f p =
                            sobol_pair(scalar::make_pixel_seed(1, 17, 4), block * count + k, pair);
                        const uint32_t x = uint32_t(p.x * float(1u << bits_x));
                        const uint32_t y = uint32_t(p.y * float(1u << (m - bits_x)));
                        ++cells[(y << bits_x) + x];
                    }
                    for (int hits : cells) ASSERT_EQ(hits, 1) << "m " << m << " split " << bits_x;
                }
            }
}

TEST(Sobol, gives_unrelated_points_to_neighbouring_pixels_pairs_and_seeds) {
    const auto correlation = [](uint32_t seed_a, uint32_t pair_a, uint32_t seed_b, uint32_t pair_b) {
        double sum = 0;
        const int n = 4096;
        for (uint32_t k = 0; k < n; ++k) {
            const Vec2f a = sobol_pair(seed_a, k, pair_a), b = sobol_pair(seed_b, k, pair_b);
            sum += (a.x - 0.5) * (b.x - 0.5) + (a.y - 0.5) * (b.y - 0.5) + (a.x - 0.5) * (b.y - 0.5);
        }
        return std::fabs(sum / n) * 12 / 3;
    };
    const uint32_t here = scalar::make_pixel_seed(0, 10, 10);
    EXPECT_LT(correlation(here, 0, scalar::make_pixel_seed(0, 11, 10), 0), 0.05);
    EXPECT_LT(correlation(here, 0, scalar::make_pixel_seed(0, 10, 11), 0), 0.05);
    EXPECT_LT(correlation(here, 0, scalar::make_pixel_seed(1, 10, 10), 0), 0.05);
    EXPECT_LT(correlation(here, 0, here, 1), 0.05);
    EXPECT_LT(correlation(here, 2, here, 7), 0.05);
}

TEST(Sobol, has_distinct_pixel_seeds) {
    std::set<uint32_t> seeds;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) seeds.insert(scalar::make_pixel_seed(7, x, y));
    EXPECT_EQ(seeds.size(), 64u * 64u);
}

TEST(Sobol, integrates_a_smooth_function_far_better_than_random_numbers) {
    double worst = 0;
    for (uint32_t pixel = 0; pixel < 64; ++pixel) {
        double sum = 0;
        for (uint32_t k = 0; k < 256; ++k) {
            const Vec2f p = sobol_pair(scalar::make_pixel_seed(3, pixel, 0), k, 2);
            sum += double(p.x) * p.x * p.y;
        }
        worst = std::max(worst, std::fabs(sum / 256 - 1.0 / 6));
    }
    EXPECT_LT(worst, 2e-3); // random points: standard deviation 0.012
}

TEST(Sobol, stays_below_one) {
    EXPECT_LT(scalar::uint_to_unit(0xffffffffu), 1.0f);
    EXPECT_EQ(scalar::uint_to_unit(0u), 0.0f);
    EXPECT_EQ(scalar::reverse_bits(0x80000001u), 0x80000001u);
    EXPECT_EQ(scalar::reverse_bits(0x00000006u), 0x60000000u);
}

} // namespace
} // namespace relief
