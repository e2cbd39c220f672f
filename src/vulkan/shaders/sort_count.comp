// First step of a pass: counts each digit in each tile. histogram[digit * tiles + tile].
#extension GL_EXT_scalar_block_layout : require
#include "sort.glsl"

shared uint counts[kSortDigitCount];

void main() {
    uint tile = group_index();
    uint tile_count = count_tiles();
    if (tile >= tile_count) return;
    uint lane = gl_LocalInvocationID.x;
    if (lane < kSortDigitCount) counts[lane] = 0u;
    barrier();
    uint pair_count = count_pairs();
    for (uint k = 0u; k < kSortItemCount; ++k) {
        uint i = tile * kSortTileSize + k * kSortGroupSize + lane;
        if (i < pair_count) atomicAdd(counts[find_digit(load_pair(i))], 1u);
    }
    barrier();
    if (lane < kSortDigitCount) histogram[lane * tile_count + tile] = counts[lane];
}
