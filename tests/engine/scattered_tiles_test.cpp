// The order in which tiles of a picture are traced.
#include "engine/scattered_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "engine/picture_windows.h"

namespace relief {

namespace {

bool precedes(const Window& a, const Window& b) { return std::tie(a.y0, a.x0) < std::tie(b.y0, b.x0); }

} // namespace

TEST(ScatteredTiles, are_the_tiles_of_the_window_each_once) {
    for (const Window& window : {Window{0, 0, 1, 1}, Window{5, 3, 145, 130}, Window{512, 16, 528, 700}}) {
        std::vector<Window> tiles = cut_into_scattered_tiles(window, 16);
        std::ranges::sort(tiles, precedes);
        EXPECT_EQ(tiles, cut_into_windows(window, 16));
    }
}

TEST(ScatteredTiles, are_spread_evenly_wherever_one_stops) {
    constexpr int kSide = 32, kEdge = 16, kParts = 4;
    const std::vector<Window> tiles = cut_into_scattered_tiles({0, 0, kSide * kEdge, kSide * kEdge}, kEdge);
    for (const size_t done : {64u, 100u, 256u, 512u, 700u, 1000u}) {
        std::vector<int> counts(kParts * kParts);
        for (size_t k = 0; k < done; ++k) {
            constexpr int kPart = kSide * kEdge / kParts;
            ++counts[size_t(tiles[k].y0 / kPart * kParts + tiles[k].x0 / kPart)];
        }
        const double mean = double(done) / double(counts.size());
        for (const int count : counts) EXPECT_NEAR(count, mean, 1) << "of " << done;
    }
}

TEST(ScatteredTiles, show_no_rows_and_no_columns) {
    constexpr int kSide = 32;
    const std::vector<Window> tiles = cut_into_scattered_tiles({0, 0, kSide, kSide}, 1);
    std::vector<int> rows(kSide), columns(kSide);
    for (size_t k = 0; k < tiles.size() / 2; ++k) {
        ++rows[size_t(tiles[k].y0)], ++columns[size_t(tiles[k].x0)];
        if (k + 1 != tiles.size() / 4) continue;
        for (const int count : rows)
            EXPECT_NEAR(count, kSide / 4, 6) << "of 16 groups one tile each, by chance";
        for (const int count : columns) EXPECT_NEAR(count, kSide / 4, 6);
    }
    for (const int count : rows) EXPECT_EQ(count, kSide / 2) << "diagonal tiles follow each other";
    for (const int count : columns) EXPECT_EQ(count, kSide / 2);
}

} // namespace relief
