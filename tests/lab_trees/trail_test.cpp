#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "lab/walks/trail.h"

namespace relief {
namespace {

using namespace scalar;

HeapKey make_key(uint64_t bits) { return {uint32_t(bits), uint32_t(bits >> 32)}; }
uint64_t to_bits(const HeapKey& key) { return uint64_t(key.high) << 32 | key.low; }

constexpr uint64_t kCorners[] = {0,
                                 1,
                                 2,
                                 3,
                                 0x7fffffff,
                                 0x80000000,
                                 0xffffffff,
                                 0x100000000,
                                 0x1ffffffff,
                                 0x7fffffffffffffff,
                                 0x8000000000000000,
                                 0xfffffffffffffffe,
                                 0xffffffffffffffff};

template <class Check> void for_many_bits(Check&& check) {
    for (const uint64_t bits : kCorners) check(bits);
    std::mt19937_64 random(1);
    for (int k = 0; k < 20000; ++k) check(random() >> (random() % 64) << (random() % 64));
}

TEST(Trail, counts_zeros_and_ones_from_the_lowest_bit) {
    for_many_bits([](uint64_t bits) {
        EXPECT_EQ(count_trailing_zeros(make_key(bits)), uint32_t(std::countr_zero(bits)));
        EXPECT_EQ(count_trailing_ones(make_key(bits)), uint32_t(std::countr_one(bits)));
        EXPECT_EQ(count_trailing_zeros(uint32_t(bits)), uint32_t(std::countr_zero(uint32_t(bits))));
        EXPECT_EQ(count_trailing_ones(uint32_t(bits)), uint32_t(std::countr_one(uint32_t(bits))));
    });
}

TEST(Trail, shifts_adds_and_cuts_two_words_like_one) {
    for_many_bits([](uint64_t bits) {
        for (const uint32_t shift : {0u, 1u, 31u, 32u, 33u, 63u, 64u}) {
            EXPECT_EQ(to_bits(shift_right(make_key(bits), shift)), shift < 64 ? bits >> shift : 0);
            EXPECT_EQ(shift_right(uint32_t(bits), shift), shift < 32 ? uint32_t(bits) >> shift : 0);
        }
        for (const uint64_t other : kCorners) {
            EXPECT_EQ(to_bits(add_bits(make_key(bits), make_key(other))), bits + other);
            EXPECT_EQ(to_bits(join_bits(make_key(bits), make_key(other))), bits | other);
            EXPECT_EQ(has_common_bits(make_key(bits), make_key(other)), (bits & other) != 0);
            EXPECT_EQ(is_equal(make_key(bits), make_key(other)), bits == other);
        }
        for (int level = 0; level < 64; ++level) {
            const uint64_t below = (uint64_t(1) << level) - 1;
            EXPECT_EQ(to_bits(clear_below(make_key(bits), make_key(below + 1))), bits & ~below);
        }
        EXPECT_EQ(to_bits(get_lowest_bit(make_key(bits))), bits & (~bits + 1));
        EXPECT_EQ(to_bits(get_highest_bit(make_key(bits))), std::bit_floor(bits));
        EXPECT_EQ(to_bits(append_bit(make_key(bits), 1u)), bits * 2 + 1);
        EXPECT_EQ(to_bits(flip_lowest(make_key(bits))), bits ^ 1);
        if (bits != 0) EXPECT_EQ(get_key_level(make_key(bits)), uint32_t(std::bit_width(bits) - 1));
    });
}

TEST(Trail, ends_when_all_levels_are_finished) {
    for (int level = 0; level <= int(kTrailLevels64); ++level) {
        const uint64_t finished = (uint64_t(2) << level) - 1, key = finished; // the last node of its level
        EXPECT_TRUE(is_zero(find_next_key(make_key(key), make_key(finished)))) << level;
        EXPECT_EQ(to_bits(find_next_trail(make_key(finished))), 1u) << level;
        EXPECT_TRUE(is_zero(find_postponed_key(make_key(key), make_key(0)))) << level;
        EXPECT_TRUE(is_zero(find_postponed_trail(make_key(0))));
        if (level > int(kTrailLevels32)) continue;
        EXPECT_EQ(find_next_key(uint32_t(key), uint32_t(finished)), 0u);
        EXPECT_EQ(find_next_trail(uint32_t(finished)), 1u);
        EXPECT_EQ(find_postponed_key(uint32_t(key), 0u), 0u);
    }
    EXPECT_EQ(find_next_key(0xffffffffu, 0xffffffffu), 0u);
    EXPECT_EQ(find_next_trail(0xffffffffu), 1u);
}

TEST(Trail, steps_to_the_sibling_of_the_lowest_level_that_is_not_finished) {
    // Root, left, right, left: at 0b1010 with the first and the last level begun and the middle one finished.
    EXPECT_EQ(find_next_key(0b1010u, 0b1010u), 0b1011u);
    EXPECT_EQ(find_next_trail(0b1010u), 0b1011u);
    EXPECT_EQ(find_next_key(0b1011u, 0b1011u), 0b11u);
    EXPECT_EQ(find_next_trail(0b1011u), 0b11u);
    EXPECT_EQ(find_next_key(0b11u, 0b11u), 0u);
}

TEST(Trail, of_both_widths_agrees) {
    std::mt19937 random(2);
    for (int k = 0; k < 20000; ++k) {
        const uint32_t level = random() % (kTrailLevels32 + 1);
        const uint32_t top = 1u << level;
        const uint32_t key = top | (random() % top), trail = top | (random() % top),
                       postponed = random() % top;
        EXPECT_EQ(to_bits(find_next_key(make_key(key), make_key(trail))), find_next_key(key, trail));
        EXPECT_EQ(to_bits(find_next_trail(make_key(trail))), find_next_trail(trail));
        EXPECT_EQ(to_bits(find_postponed_key(make_key(key), make_key(postponed))),
                  find_postponed_key(key, postponed));
        EXPECT_EQ(to_bits(find_postponed_trail(make_key(postponed))), find_postponed_trail(postponed));
        EXPECT_EQ(to_bits(make_trail(make_key(key))), make_trail(key));
        EXPECT_EQ(to_bits(make_postponed(make_key(key))), make_postponed(key));
    }
    EXPECT_EQ(make_postponed(0u), 0u);
    EXPECT_TRUE(is_zero(make_postponed(make_key(0))));
    EXPECT_EQ(to_bits(make_postponed(make_key(uint64_t(1) << 32))), 0xffffffffu);
}

TEST(Trail, of_restarts_climbs_over_finished_levels) {
    const uint32_t root = make_root_level32();
    EXPECT_TRUE(is_root_finished(pop_level(root, root)));
    EXPECT_TRUE(is_root_finished(pop_level(make_root_level64(), make_root_level64())));
    // The child visited first, on the level below the root, is done; then the other one too.
    const uint32_t first = pop_level(root, root >> 1);
    EXPECT_EQ(first, root | root >> 1);
    EXPECT_TRUE(is_root_finished(pop_level(first, root >> 1)));
    const uint32_t lowest = root >> kTrailLevels32;
    EXPECT_EQ(lowest, 1u);
    EXPECT_TRUE(is_root_finished(pop_level(0x7fffffffu, lowest)));
}

} // namespace
} // namespace relief
