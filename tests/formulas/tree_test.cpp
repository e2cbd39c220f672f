#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "formulas/tree.h"

namespace relief {
namespace {

TEST(Tree, words_of_nodes_keep_axis_count_and_kind_apart) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
        EXPECT_FALSE(scalar::is_leaf_word(scalar::make_inner_word(axis)));
        EXPECT_EQ(scalar::get_word_axis(scalar::make_inner_word(axis)), axis);
    }
    EXPECT_TRUE(scalar::is_leaf_word(1));
    EXPECT_TRUE(scalar::is_leaf_word(1u << 28)); // a kind without a count
    EXPECT_EQ(scalar::get_word_count(3u << 28 | 17u), 17u);
    EXPECT_EQ(scalar::get_word_count(scalar::kNodeCountMask), scalar::kNodeCountMask);
}

TEST(Tree, ranks_the_bits_of_two_words) {
    std::mt19937 random(1);
    for (int k = 0; k < 1000; ++k) {
        const uint32_t low = uint32_t(random()), high = uint32_t(random());
        const uint64_t bits = uint64_t(high) << 32 | low;
        uint32_t rank = 0;
        for (uint32_t place = 0; place < 64; ++place) {
            ASSERT_EQ(scalar::rank_bits(low, high, place), rank);
            rank += (bits >> place) & 1u;
        }
    }
}

TEST(Tree, moves_origins_as_if_rounded_once) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int k = 0; k < 200000; ++k) {
        const float speed = unit(random), t = std::exp(12 * unit(random));
        const float origin = -speed * t * (1 + 1e-3f * unit(random));
        const float exact = std::fma(speed, t, origin);
        ASSERT_NEAR(scalar::move_origin(origin, speed, t), exact, 1.2e-7f * std::fabs(exact));
    }
    EXPECT_EQ(scalar::move_origin(3e38f, -1, 2e38f), 3e38f - 2e38f);
    EXPECT_EQ(scalar::move_origin(-1e30f, 1, 1e30f), 0);
    EXPECT_EQ(scalar::move_origin(5, 0, 1e33f), 5);
}

} // namespace
} // namespace relief
