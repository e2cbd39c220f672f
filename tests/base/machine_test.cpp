#include "base/machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace relief {
namespace {

constexpr uint64_t kMebibyte = 1024 * 1024;

TEST(Memory, counts_pages_that_were_touched_in_the_peak) {
    const uint64_t before = peak_resident_bytes();
    EXPECT_GT(before, kMebibyte / 4);
    const std::vector<char> block(64 * kMebibyte, 'x');
    ASSERT_EQ(std::count(block.begin(), block.end(), 'x'), ptrdiff_t(block.size()));
    const uint64_t after = peak_resident_bytes();
    EXPECT_GE(after, 64 * kMebibyte);
    EXPECT_GE(after, before);
}

TEST(Memory, tells_a_plausible_amount_that_is_available) {
    EXPECT_GT(available_memory_bytes(), 16 * kMebibyte);
}

} // namespace
} // namespace relief
