// Third step of a pass: moves each pair to its digit's start in its tile, plus its rank there. Stable.
#extension GL_EXT_scalar_block_layout : require
#include "sort.glsl"

// 16-bit counts, two digits per word, one column per lane: prefix sums over the lanes for each digit.
const uint kRowCount = kSortDigitCount / 2u;
shared uint columns[kRowCount * kSortGroupSize];

void scan_columns(const uint lane) {
    uint below[kRowCount];
    for (uint distance = 1u; distance < kSortGroupSize; distance *= 2u) {
        barrier();
        for (uint row = 0u; row < kRowCount; ++row)
            below[row] = lane >= distance ? columns[row * kSortGroupSize + lane - distance] : 0u;
        barrier();
        for (uint row = 0u; row < kRowCount; ++row) columns[row * kSortGroupSize + lane] += below[row];
    }
    barrier();
}

void store_pair(const uint i, const uvec2 pair) {
    if (push.is_back != 0u)
        pairs[i] = pair;
    else
        sorted_pairs[i] = pair;
}

void main() {
    uint tile = group_index();
    uint tile_count = count_tiles();
    if (tile >= tile_count) return;
    uint lane = gl_LocalInvocationID.x;
    for (uint row = 0u; row < kRowCount; ++row) columns[row * kSortGroupSize + lane] = 0u;
    // Each lane takes consecutive pairs, so that lane order is pair order.
    uint first = tile * kSortTileSize + lane * kSortItemCount;
    uint pair_count = count_pairs();
    uint rank[kSortItemCount];
    for (uint k = 0u; k < kSortItemCount; ++k) {
        if (first + k >= pair_count) break;
        uint digit = find_digit(load_pair(first + k));
        uint place = (digit >> 1u) * kSortGroupSize + lane;
        uint half_shift = (digit & 1u) * 16u;
        rank[k] = columns[place] >> half_shift & 0xffffu;
        columns[place] += 1u << half_shift;
    }
    scan_columns(lane);
    for (uint k = 0u; k < kSortItemCount; ++k) {
        if (first + k >= pair_count) break;
        uvec2 pair = load_pair(first + k);
        uint digit = find_digit(pair);
        uint before = 0u;
        if (lane > 0u)
            before = columns[(digit >> 1u) * kSortGroupSize + lane - 1u] >> (digit & 1u) * 16u & 0xffffu;
        store_pair(histogram[digit * tile_count + tile] + before + rank[k], pair);
    }
}
