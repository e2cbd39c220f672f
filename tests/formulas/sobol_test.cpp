#include <algorithm>
#include <numbers>
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

/// The least t of which the first 2^a points of the first 2^b pixels of a block, along its curve, are a
/// (t, a + b, 2)-net: every stratum of area 2^(t - a - b) has 2^t of them.
uint32_t find_net_quality(uint32_t block, uint32_t pair, uint32_t a, uint32_t b) {
    for (uint32_t t = 0;; ++t) {
        const uint32_t bits = a + b - t;
        bool is_net = true;
        for (uint32_t bits_x = 0; bits_x <= bits; ++bits_x) {
            std::vector<uint32_t> cells(1u << bits);
            for (uint32_t place = 0; place < 1u << b; ++place)
                for (uint32_t k = 0; k < 1u << a; ++k) {
                    const Vec2f p = sobol_pair(block | place, k, pair);
                    ++cells[(uint32_t(p.y * float(1u << (bits - bits_x))) << bits_x) +
                            uint32_t(p.x * float(1u << bits_x))];
                }
            is_net = is_net && std::ranges::all_of(cells, [&](uint32_t n) { return n == 1u << t; });
        }
        if (is_net) return t;
    }
}

TEST(Sobol, spreads_the_first_sixteen_points_over_neighbouring_pixels) {
    for (const uint32_t x : {0u, 8u, 4096u})
        for (const uint32_t pair : {0u, 7u})
            for (uint32_t a = 0; a <= 4; ++a)
                for (uint32_t b = 0; b <= 6 - a; ++b) {
                    const uint32_t t = find_net_quality(scalar::make_pixel_seed(5, x, 16), pair, a, b);
                    const bool is_worse = a == 3 && b == 2;
                    EXPECT_LE(t, is_worse ? 2u : 1u) << "2^" << a << " points of 2^" << b << " pixels";
                    const bool is_even = b == 0 || b == 2 || b == 4 || (a == 0 && b == 6);
                    if ((a == 0 || a == 4) && is_even) EXPECT_EQ(t, 0u) << a << ' ' << b;
                }
}

/// Mean square over many blocks of 4 x 4 pixels of the error of their mean, over that of pixels whose errors
/// are independent.
template <class Function>
double measure_error_of_blocks(const Function& function, double integral, uint32_t count) {
    double of_pixels = 0, of_blocks = 0;
    for (uint32_t block = 0; block < 1000; ++block) {
        double sum = 0;
        for (uint32_t i = 0; i < 16; ++i) {
            const uint32_t seed = scalar::make_pixel_seed(9, block * 8 + i % 4, i / 4);
            double error = -integral;
            for (uint32_t k = 0; k < count; ++k) error += function(sobol_pair(seed, k, 3)) / double(count);
            of_pixels += error * error / 16;
            sum += error / 16;
        }
        of_blocks += sum * sum;
    }
    return of_blocks / of_pixels * 16;
}

TEST(Sobol, has_errors_that_neighbouring_pixels_cancel) {
    const auto is_inside = [](const Vec2f& p) {
        return double((p.x - 0.4f) * (p.x - 0.4f) + (p.y - 0.5f) * (p.y - 0.5f) < 0.1f);
    };
    const auto multiply = [](const Vec2f& p) { return double(p.x) * p.x * p.y; };
    for (const uint32_t count : {1u, 4u, 16u}) {
        EXPECT_LT(measure_error_of_blocks(is_inside, 0.1 * std::numbers::pi, count), 0.45) << count;
        EXPECT_LT(measure_error_of_blocks(multiply, 1.0 / 6, count), 0.35) << count;
    }
    for (const uint32_t count : {64u, 128u, 256u, 1024u}) { // of independent pixels 1 +- 0.05
        EXPECT_LT(measure_error_of_blocks(is_inside, 0.1 * std::numbers::pi, count), 1.15) << count;
        EXPECT_LT(measure_error_of_blocks(multiply, 1.0 / 6, count), 1.15) << count;
    }
}

/// Chi-square of points in a grid of 64 x 64 cells, in standard deviations; `draw`: a point by its number.
template <class Draw> double measure_unevenness(const Draw& draw) {
    constexpr uint32_t kCells = 64, kCount = 1u << 20;
    std::vector<uint32_t> cells(kCells * kCells);
    for (uint32_t n = 0; n < kCount; ++n) {
        const Vec2f p = draw(n);
        ++cells[uint32_t(p.x * kCells) * kCells + uint32_t(p.y * kCells)];
    }
    const double expected = double(kCount) / double(cells.size()), freedom = double(cells.size() - 1);
    double chi_square = 0;
    for (const uint32_t n : cells) chi_square += (n - expected) * (n - expected) / expected;
    return (chi_square - freedom) / std::sqrt(2 * freedom);
}

TEST(Sobol, spreads_points_uniformly_over_seeds) {
    for (const uint32_t k : {0u, 1u, 6u, 37u}) {
        const auto at = [](uint32_t n) { return scalar::make_pixel_seed(n, 5, 2); };
        EXPECT_LT(measure_unevenness([&](uint32_t n) { return sobol_pair(at(n), k, 4); }), 5) << k;
        const auto of_two_pairs = [&](uint32_t n) {
            return Vec2f{sobol_pair(at(n), k, 4).x, sobol_pair(at(n), k, 5).x};
        };
        EXPECT_LT(measure_unevenness(of_two_pairs), 5) << k;
    }
}

/// A pixel whose pairs draw their points in nearly the same order would have an error far above that of
/// others, at any number of samples.
TEST(Sobol, has_no_pixel_with_far_larger_errors_than_others) {
    constexpr uint32_t kPixels = 4096, kCount = 1024;
    double square = 0, fourth = 0, largest = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const uint32_t seed = scalar::make_pixel_seed(2, pixel % 64, pixel / 64);
        double error = 0;
        for (uint32_t k = 0; k < kCount; ++k)
            error += (sobol_pair(seed, k, 4).x - 0.5) * (sobol_pair(seed, k, 5).x - 0.5) / kCount;
        square += error * error / kPixels, fourth += std::pow(error, 4) / kPixels;
        largest = std::max(largest, std::fabs(error));
    }
    EXPECT_LT(fourth / (square * square), 4) << "3 for normal errors";
    EXPECT_LT(largest, 6 * std::sqrt(square));
}

TEST(Sobol, stays_below_one) {
    EXPECT_LT(scalar::uint_to_unit(0xffffffffu), 1.0f);
    EXPECT_EQ(scalar::uint_to_unit(0u), 0.0f);
    EXPECT_EQ(scalar::reverse_bits(0x80000001u), 0x80000001u);
    EXPECT_EQ(scalar::reverse_bits(0x00000006u), 0x60000000u);
}

} // namespace
} // namespace relief
