#include "surface/patch/edge_overrides.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace relief {
namespace {

TEST(EdgeOverrides, find_what_was_put_in_and_nothing_else) {
    for (const uint32_t patch_count : {1u, 16u, 17u, 1000u}) {
        std::mt19937 random(patch_count);
        std::map<uint32_t, std::array<uint32_t, 2>> expected;
        std::vector<EdgeOverride> entries;
        for (uint32_t patch_edge = 0; patch_edge < 4 * patch_count; ++patch_edge) {
            const bool is_last = patch_edge + 1 == 4 * patch_count;
            if (!is_last && random() % 5 != 0) continue;
            entries.push_back({patch_edge, uint32_t(random()) % 100000, uint32_t(random()) % 100000});
            expected[patch_edge] = {entries.back().first, entries.back().second};
        }
        const EdgeOverrides overrides(entries, patch_count);
        EXPECT_EQ(overrides.size(), expected.size());
        for (uint32_t patch_edge = 0; patch_edge < 4 * patch_count; ++patch_edge) {
            ASSERT_EQ(overrides.contains(patch_edge), expected.contains(patch_edge)) << patch_edge;
            if (expected.contains(patch_edge)) {
                EXPECT_EQ(overrides.ends(patch_edge), expected[patch_edge]) << patch_edge;
            }
        }
        const std::vector<EdgeOverride> list = overrides.list();
        ASSERT_EQ(list.size(), entries.size());
        for (size_t k = 0; k < list.size(); ++k) {
            EXPECT_EQ(list[k].patch_edge, entries[k].patch_edge);
            EXPECT_EQ(list[k].first, entries[k].first);
            EXPECT_EQ(list[k].second, entries[k].second);
        }
    }
}

TEST(EdgeOverrides, take_nothing_where_there_are_none) {
    const EdgeOverrides none({}, 1000);
    EXPECT_TRUE(none.empty());
    EXPECT_FALSE(none.contains(3999));
    EXPECT_EQ(none.byte_count(), 0u);
    EXPECT_TRUE(none.list().empty());
}

} // namespace
} // namespace relief
