#include "engine/scattered_tiles.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "engine/picture_windows.h"
#include "formulas/sobol.h"

namespace relief {

namespace {

constexpr int kLevels = 16; ///< of groups: 2^16 tiles a side are more than any picture has
/// Of the four of a group: diagonal ones follow each other.
constexpr uint32_t kPlaces[4] = {0, 2, 3, 1};

/// Digits of base 4, the highest that of the smallest group: the place of a tile in each group, shuffled.
uint64_t find_place(uint32_t column, uint32_t row) {
    uint64_t place = 0;
    for (int level = 0; level < kLevels; ++level) {
        const uint32_t child = (column & 1) | (row & 1) << 1;
        column >>= 1, row >>= 1;
        const uint32_t group = scalar::hash_combine(scalar::hash_combine(uint32_t(level), column), row);
        const uint32_t shuffle = scalar::hash_uint(group) & 3;
        place = place << 2 | kPlaces[child ^ shuffle];
    }
    return place;
}

} // namespace

std::vector<Window> cut_into_scattered_tiles(const Window& window, int edge) {
    std::vector<std::pair<uint64_t, Window>> placed;
    for (const Window& tile : cut_into_windows(window, edge))
        placed.push_back({find_place(uint32_t(tile.x0 / edge), uint32_t(tile.y0 / edge)), tile});
    std::ranges::sort(placed, {}, &std::pair<uint64_t, Window>::first);
    std::vector<Window> tiles;
    for (const auto& [place, tile] : placed) tiles.push_back(tile);
    return tiles;
}

} // namespace relief
