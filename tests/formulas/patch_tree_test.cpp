// Complete quad trees without links, and the samples that edges move to.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "formulas/levels.h"
#include "formulas/patch_tree.h"

namespace relief {

namespace {

TEST(bottom_tree, numbers_cells_in_morton_order) {
    for (uint32_t level = 0; level <= scalar::kTreeLevels; ++level) {
        const uint32_t side = 1u << level;
        std::set<uint32_t> seen;
        for (uint32_t number = 0; number < side * side; ++number) {
            const uint32_t column = scalar::morton_column(number), row = scalar::morton_row(number);
            ASSERT_LT(column, side);
            ASSERT_LT(row, side);
            seen.insert(row * side + column);
            if (level == 0) continue;
            EXPECT_EQ(scalar::morton_column(number >> 2), column / 2);
            EXPECT_EQ(scalar::morton_row(number >> 2), row / 2);
        }
        EXPECT_EQ(seen.size(), size_t(side) * side);
    }
}

TEST(bottom_tree, counts_the_words_of_a_tree) {
    EXPECT_EQ(scalar::count_nodes_above(0), 0u);
    EXPECT_EQ(scalar::count_nodes_above(1), 1u);
    EXPECT_EQ(scalar::count_nodes_above(6), 1365u);
    for (uint32_t level = 0; level <= scalar::kTreeLevels; ++level) {
        const uint32_t side = (1u << level) + 1;
        const uint32_t words = scalar::first_vertex_word(level) + 3 * side * side;
        EXPECT_GE(scalar::count_tree_units(level) * scalar::kPoolUnitWords, words);
        EXPECT_LT((scalar::count_tree_units(level) - 1) * scalar::kPoolUnitWords, words);
    }
}

TEST(bottom_tree, walks_backwards_by_an_exclusive_or) {
    for (int backward = 0; backward < 4; ++backward) {
        const uint32_t mask = scalar::make_order_mask(backward & 1, backward & 2) & 1023u;
        const uint32_t first = 0u ^ mask;
        EXPECT_EQ(scalar::morton_column(first), backward & 1 ? 31u : 0u);
        EXPECT_EQ(scalar::morton_row(first), backward & 2 ? 31u : 0u);
    }
}

TEST(bottom_tree, says_in_its_need_how_far_edges_move) {
    const uint32_t field = 5u | 5u << 4 | 4u << 8 | 2u << 12 | 0u << 16;
    const uint32_t need = scalar::make_need(3, field);
    EXPECT_EQ(need & 63u, 1u << 3);
    EXPECT_EQ(scalar::need_moves(need, 0), 0u);
    EXPECT_EQ(scalar::need_moves(need, 1), 1u << 1);
    EXPECT_EQ(scalar::need_moves(need, 2), 1u << 3);
    EXPECT_EQ(scalar::need_moves(need, 3), 1u << 5);
}

/// Where the samples of an edge of level `edge_level` move to on a patch of level `level`, counted along its
/// line.
std::vector<uint32_t> list_moved(uint32_t level, uint32_t edge_level, uint32_t edge, uint32_t reversed) {
    std::vector<uint32_t> places;
    const uint32_t n = 1u << level;
    for (uint32_t k = 0; k <= n; ++k) {
        const uint32_t i = edge == 0 ? k : edge == 1 ? n : edge == 2 ? n - k : 0;
        const uint32_t j = edge == 0 ? 0 : edge == 1 ? k : edge == 2 ? n : n - k;
        if (scalar::find_sample_edge(i, j, level) == 4) continue;
        EXPECT_EQ(scalar::find_sample_edge(i, j, level), edge);
        const scalar::GridSample moved =
            scalar::move_boundary_sample(i, j, level, edge, level - edge_level, reversed);
        places.push_back(
            scalar::find_line_sample(moved.i, moved.j, level, edge, (reversed >> edge & 1) != 0));
        EXPECT_EQ(edge % 2 == 0 ? moved.j : moved.i, edge % 2 == 0 ? j : i) << "stays on its edge";
    }
    return places;
}

TEST(levels, moves_samples_onto_those_of_the_edge_from_either_side) {
    for (uint32_t level = 1; level <= 5; ++level)
        for (uint32_t edge_level = 0; edge_level <= level; ++edge_level)
            for (uint32_t edge = 0; edge < 4; ++edge)
                for (const uint32_t reversed : {0u, 15u}) {
                    std::vector<uint32_t> places = list_moved(level, edge_level, edge, reversed);
                    for (const uint32_t place : places) EXPECT_EQ(place % (1u << (level - edge_level)), 0u);
                    std::set<uint32_t> kept(places.begin(), places.end());
                    kept.insert({0u, 1u << level});
                    EXPECT_EQ(kept.size(), (1u << edge_level) + 1u) << "every sample of the edge is there";
                }
}

} // namespace

} // namespace relief
