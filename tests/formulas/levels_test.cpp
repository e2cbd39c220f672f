// Packed levels of a patch and its edges.
#include "formulas/levels.h"

#include <gtest/gtest.h>

namespace relief::scalar {
namespace {

TEST(Levels, up_to_seven_are_the_same_after_three_bits_each) {
    for (uint32_t patch = 0; patch <= kMaxNarrowLevel; ++patch)
        for (uint32_t edge = 0; edge < 4; ++edge)
            for (uint32_t level = 0; level <= patch; ++level) {
                const uint32_t shift = 4 + 4 * edge;
                const uint32_t packed = (pack_uniform_level(patch) & ~(15u << shift)) | level << shift;
                EXPECT_LT(narrow_levels(packed), 1u << 15);
                EXPECT_EQ(widen_levels(narrow_levels(packed)), packed);
                // What another patch has in the same word does not matter.
                EXPECT_EQ(widen_levels(narrow_levels(packed) | 0xffff8000u), packed);
            }
}

} // namespace
} // namespace relief::scalar
