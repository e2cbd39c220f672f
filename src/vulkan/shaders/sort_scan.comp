// Second step: exclusive prefix sum of the histogram, one group, kSortGroupSize * kSortItemCount words at a time.
#extension GL_EXT_scalar_block_layout : require
#include "sort.glsl"

shared uint sums[kSortGroupSize];

/// Exclusive prefix sum over the lanes; `sums` holds the inclusive sums afterwards.
uint scan_lanes(const uint lane, const uint value) {
    sums[lane] = value;
    barrier();
    for (uint distance = 1u; distance < kSortGroupSize; distance *= 2u) {
        uint below = lane >= distance ? sums[lane - distance] : 0u;
        barrier();
        sums[lane] += below;
        barrier();
    }
    return sums[lane] - value;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint word_count = count_tiles() * kSortDigitCount;
    uint total = 0u;
    for (uint begin = 0u; begin < word_count; begin += kSortTileSize) {
        uint first = begin + lane * kSortItemCount;
        uint own = 0u;
        for (uint k = 0u; k < kSortItemCount; ++k)
            if (first + k < word_count) own += histogram[first + k];
        uint place = total + scan_lanes(lane, own);
        total += sums[kSortGroupSize - 1u];
        barrier(); // before the next iteration overwrites the sums
        for (uint k = 0u; k < kSortItemCount; ++k) {
            if (first + k >= word_count) break;
            uint count = histogram[first + k];
            histogram[first + k] = place;
            place += count;
        }
    }
}
