// Where the node of a key lies in a succinct heap: one read of the flat directory, and one of a brick for
// every six levels below it. Included as tree.h says; find_slot of such a heap calls it.
#ifndef RELIEF_SUCCINCT_HEAP_H
#ifndef __cplusplus
#define RELIEF_SUCCINCT_HEAP_H
#endif

/// Of a key that is in the tree.
uint find_succinct_slot(Key key) {
    Key parent = shift_right(key, 1u);
    if (is_zero(parent)) return 1u;
    HeapForm form = get_heap_form();
    uint level = get_key_level(parent);
    uint depth = level > form.flat_levels ? level - form.flat_levels : 0u; // still to go down
    uint flat_key = get_low_word(shift_right(parent, depth));
    HeapBlock block = load_heap_block(flat_key >> 6u);
    count_bytes(kHeapBlockBytes);
    uint rank = block.rank + rank_bits(block.inner_low, block.inner_high, flat_key & 63u);
    uint side = get_low_word(key) & 1u;
    if (level < form.flat_levels) return 2u + 2u * rank + side;
    HeapBrick brick = load_heap_brick(rank - form.flat_pairs);
    count_bytes(kHeapBrickBytes);
    while (depth >= kBrickLevels) {
        depth -= kBrickLevels;
        uint place = get_low_word(shift_right(parent, depth)) & 63u;
        brick = load_heap_brick(brick.first_brick + rank_bits(brick.deeper_low, brick.deeper_high, place));
        count_bytes(kHeapBrickBytes);
    }
    uint local = (1u << depth) | (get_low_word(parent) & ((1u << depth) - 1u));
    return 2u + 2u * (brick.first_pair + rank_bits(brick.inner_low, brick.inner_high, local)) + side;
}

#endif
