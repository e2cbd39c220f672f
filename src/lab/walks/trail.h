// Integer steps of traversals that keep their way in the bits of a key of 32 bits (uint) or 64 (HeapKey).
// Keys number a binary tree as a heap: root 1, children 2n and 2n + 1, 0 no node. A trail has a bit a level.
#ifndef RELIEF_TRAIL_H
#define RELIEF_TRAIL_H
#include "formulas/begin.h"

/// Levels below the root that each width has room for: the top bit is left free for the carry.
const uint kTrailLevels32 = 30u;
const uint kTrailLevels64 = 62u;

struct HeapKey {
    uint low, high;
};

/// 32 for 0, where findLSB says -1.
FN uint count_trailing_zeros(uint bits) { return bits == 0u ? 32u : uint(findLSB(bits)); }
FN uint count_trailing_zeros(HeapKey bits) {
    return bits.low != 0u ? count_trailing_zeros(bits.low) : 32u + count_trailing_zeros(bits.high);
}

FN uint count_trailing_ones(uint bits) { return count_trailing_zeros(~bits); }
FN uint count_trailing_ones(HeapKey bits) {
    HeapKey inverse = {~bits.low, ~bits.high};
    return count_trailing_zeros(inverse);
}

/// 0 for shifts of 32 and more, which neither language defines.
FN uint shift_right(uint bits, uint count) { return count < 32u ? bits >> count : 0u; }
FN HeapKey shift_right(HeapKey bits, uint count) {
    HeapKey far = {shift_right(bits.high, count - 32u), 0u};
    if (count >= 32u) return far;
    HeapKey near = {(bits.low >> count) | (count > 0u ? bits.high << (32u - count) : 0u), bits.high >> count};
    return near;
}

FN bool is_zero(uint bits) { return bits == 0u; }
FN bool is_zero(HeapKey bits) { return (bits.low | bits.high) == 0u; }

FN bool is_equal(uint a, uint b) { return a == b; }
FN bool is_equal(HeapKey a, HeapKey b) { return a.low == b.low && a.high == b.high; }

FN uint add_bits(uint a, uint b) { return a + b; }
FN HeapKey add_bits(HeapKey a, HeapKey b) {
    uint low = a.low + b.low;
    HeapKey sum = {low, a.high + b.high + (low < a.low ? 1u : 0u)};
    return sum;
}

FN uint join_bits(uint a, uint b) { return a | b; }
FN HeapKey join_bits(HeapKey a, HeapKey b) {
    HeapKey both = {a.low | b.low, a.high | b.high};
    return both;
}

FN bool has_common_bits(uint a, uint b) { return (a & b) != 0u; }
FN bool has_common_bits(HeapKey a, HeapKey b) { return ((a.low & b.low) | (a.high & b.high)) != 0u; }

/// Without the bits below the one bit of `level`.
FN uint clear_below(uint bits, uint level) { return bits & ~(level - 1u); }
FN HeapKey clear_below(HeapKey bits, HeapKey level) {
    HeapKey rest = {level.high != 0u ? 0u : bits.low & ~(level.low - 1u),
                    level.high != 0u ? bits.high & ~(level.high - 1u) : bits.high};
    return rest;
}

/// 0 for 0.
FN uint get_lowest_bit(uint bits) { return bits & (~bits + 1u); }
FN HeapKey get_lowest_bit(HeapKey bits) {
    HeapKey lowest = {get_lowest_bit(bits.low), bits.low != 0u ? 0u : get_lowest_bit(bits.high)};
    return lowest;
}

/// 0 for 0, where findMSB says -1.
FN uint get_highest_bit(uint bits) { return bits == 0u ? 0u : 1u << uint(findMSB(bits)); }
FN HeapKey get_highest_bit(HeapKey bits) {
    HeapKey highest = {bits.high != 0u ? 0u : get_highest_bit(bits.low), get_highest_bit(bits.high)};
    return highest;
}

/// Level of a key that is not 0: the root's is 0.
FN uint get_key_level(uint key) { return uint(findMSB(key)); }
FN uint get_key_level(HeapKey key) {
    return key.high != 0u ? 32u + get_key_level(key.high) : get_key_level(key.low);
}

FN uint get_low_word(uint bits) { return bits; }
FN uint get_low_word(HeapKey bits) { return bits.low; }

/// 2 bits + bit.
FN uint append_bit(uint bits, uint bit) { return (bits << 1u) | bit; }
FN HeapKey append_bit(HeapKey bits, uint bit) {
    HeapKey longer = {(bits.low << 1u) | bit, (bits.high << 1u) | (bits.low >> 31u)};
    return longer;
}

FN uint flip_lowest(uint bits) { return bits ^ 1u; }
FN HeapKey flip_lowest(HeapKey bits) {
    HeapKey flipped = {bits.low ^ 1u, bits.high};
    return flipped;
}

FN uint get_sibling_key(uint key) { return flip_lowest(key); }
FN HeapKey get_sibling_key(HeapKey key) { return flip_lowest(key); }

// Trail of finished siblings (Murguia et al. 2013): below a leading 1 a bit a level, 1: the second child is
// under way or done. After a node: its lowest levels of 1 are finished, the next sibling up is due.

/// To start at any node: nothing finished.
FN uint make_trail(uint key) { return get_highest_bit(key); }
FN HeapKey make_trail(HeapKey key) { return get_highest_bit(key); }

/// 1 where all levels are finished.
FN uint find_next_trail(uint trail) { return shift_right(trail, count_trailing_ones(trail)) + 1u; }
FN HeapKey find_next_trail(HeapKey trail) {
    HeapKey one = {1u, 0u};
    return add_bits(shift_right(trail, count_trailing_ones(trail)), one);
}

/// 0 where all levels are finished: then all bits of the trail are 1, the leading one too.
FN uint find_next_key(uint key, uint trail) {
    uint finished = count_trailing_ones(trail);
    return is_zero(shift_right(trail, finished)) ? 0u : get_sibling_key(shift_right(key, finished));
}
FN HeapKey find_next_key(HeapKey key, HeapKey trail) {
    uint finished = count_trailing_ones(trail);
    HeapKey none = {0u, 0u};
    if (is_zero(shift_right(trail, finished))) return none;
    return get_sibling_key(shift_right(key, finished));
}

// Trail of postponed siblings (Binder and Keller 2016): a bit a level, 1: the sibling is still due.

/// To start at any node: every sibling on the way to the root postponed.
FN uint make_postponed(uint key) { return key == 0u ? 0u : get_highest_bit(key) - 1u; }
FN HeapKey make_postponed(HeapKey key) {
    HeapKey top = get_highest_bit(key);
    HeapKey below = {top.high != 0u ? 0xffffffffu : top.low - 1u, top.high != 0u ? top.high - 1u : 0u};
    return is_zero(key) ? key : below;
}

/// 0 where nothing is postponed.
FN uint find_postponed_key(uint key, uint trail) {
    return trail == 0u ? 0u : get_sibling_key(shift_right(key, count_trailing_zeros(trail)));
}
FN HeapKey find_postponed_key(HeapKey key, HeapKey trail) {
    HeapKey none = {0u, 0u};
    if (is_zero(trail)) return none;
    return get_sibling_key(shift_right(key, count_trailing_zeros(trail)));
}

FN uint find_postponed_trail(uint trail) {
    return trail == 0u ? 0u : flip_lowest(shift_right(trail, count_trailing_zeros(trail)));
}
FN HeapKey find_postponed_trail(HeapKey trail) {
    if (is_zero(trail)) return trail;
    return flip_lowest(shift_right(trail, count_trailing_zeros(trail)));
}

// Restart trail (Laine 2010): one bit a level from the second highest; 1: the near child is done or single.

FN uint make_root_level32() { return 0x40000000u; }
FN HeapKey make_root_level64() {
    HeapKey level = {0u, 0x40000000u};
    return level;
}

/// After the node of `level`: the carry climbs over finished levels. Into the top bit: the root is finished.
FN uint pop_level(uint trail, uint level) { return add_bits(clear_below(trail, level), level); }
FN HeapKey pop_level(HeapKey trail, HeapKey level) { return add_bits(clear_below(trail, level), level); }

FN bool is_root_finished(uint trail) { return (trail & 0x80000000u) != 0u; }
FN bool is_root_finished(HeapKey trail) { return (trail.high & 0x80000000u) != 0u; }

#include "formulas/end.h"
#endif
