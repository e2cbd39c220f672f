#include "surface/mesh/narrow_indices.h"

#include <gtest/gtest.h>

#include <utility>

#include "surface/mesh/quad_list.h"

namespace relief {
namespace {

TEST(NarrowIndices, take_half_the_bytes_until_one_does_not_fit) {
    NarrowIndices<2> indices;
    EXPECT_TRUE(indices.empty());
    for (uint32_t k = 0; k < 100; ++k) indices.push_back({k, 0xffff - k});
    EXPECT_EQ(indices.byte_count(), 100u * 4u);
    indices.push_back({7, 0x10000});
    indices.push_back({1, 2});
    EXPECT_EQ(indices.byte_count(), 102u * 8u);
    ASSERT_EQ(indices.size(), 102u);
    for (uint32_t k = 0; k < 100; ++k) EXPECT_EQ(indices[k], (NarrowIndices<2>::Tuple{k, 0xffff - k})) << k;
    EXPECT_EQ(indices[100], (NarrowIndices<2>::Tuple{7, 0x10000}));
    EXPECT_EQ(indices[101], (NarrowIndices<2>::Tuple{1, 2}));
}

TEST(NarrowIndices, are_as_wide_as_the_largest_index_asks_for) {
    for (const auto& [end, bytes] : {std::pair(0x10000u, 8u), {0x10001u, 16u}}) {
        QuadList quads;
        quads.reset(3, end);
        EXPECT_EQ(quads.byte_count(), 3 * bytes);
        const Quad last{{0, 1, end - 1, 2}};
        quads.set(2, last);
        EXPECT_EQ(quads[2], last);
        EXPECT_EQ(quads[1], (Quad{{0, 0, 0, 0}}));
        size_t count = 0;
        for (const Quad quad : quads) EXPECT_EQ(quad, quads[count++]);
        EXPECT_EQ(count, 3u);
    }
}

} // namespace
} // namespace relief
