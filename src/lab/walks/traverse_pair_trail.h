// Postponed-bit trail (Binder and Keller 2016) on a heap: siblings are one 64-byte line, tested together;
// going back is one shift. Starts at any node. At most kTrailLevels32 or 64 levels. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_PAIR_TRAIL_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_PAIR_TRAIL_H
#endif

struct PairTrailState {
    Key key; ///< 0: ended
    Key trail;
    Key leaf;       ///< of the leaf that was visited last: where the next ray may start
    uint is_tested; ///< 1: the box of `key` was met; slot, first and word are its own
    uint slot, first, word;
};

PairTrailState pair_walk;

/// 0: no tree.
PairTrailState start_pair_trail(Key key) {
    PairTrailState state = {key, make_postponed(key), key, 0u, 0u, 0u, 0u};
    return state;
}

void leave_pair() {
    pair_walk.is_tested = 0u;
    pair_walk.key = find_postponed_key(pair_walk.key, pair_walk.trail);
    pair_walk.trail = find_postponed_trail(pair_walk.trail);
}

/// The node itself has to be read again; that its box is tested against the nearer limit costs no bytes.
void test_postponed() {
    pair_walk.slot = find_slot(pair_walk.key);
    TreeNode data = load_node(pair_walk.slot);
    count_bytes(kNodeBytes);
    count_box_test();
    if (!(enter_box(data) < make_infinity())) {
        leave_pair();
        return;
    }
    pair_walk.is_tested = 1u;
    pair_walk.first = data.first;
    pair_walk.word = data.word;
}

void choose_of_pair() {
    uint slot = find_slot(append_bit(pair_walk.key, 0u));
    TreeNode left = load_node(slot);
    TreeNode right = load_node(slot + 1u);
    count_bytes(2u * kNodeBytes);
    count_box_test();
    count_box_test();
    float left_entry = enter_box(left);
    float right_entry = enter_box(right);
    if (!(min(left_entry, right_entry) < make_infinity())) {
        leave_pair();
        return;
    }
    bool is_right_nearer = right_entry < left_entry;
    uint near = is_right_nearer ? 1u : 0u;
    pair_walk.key = append_bit(pair_walk.key, near);
    pair_walk.trail = append_bit(pair_walk.trail, max(left_entry, right_entry) < make_infinity() ? 1u : 0u);
    pair_walk.slot = slot + near;
    pair_walk.first = is_right_nearer ? right.first : left.first;
    pair_walk.word = is_right_nearer ? right.word : left.word;
}

/// False where a device ends the loop too early.
bool walk_pair_trail() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (is_zero(pair_walk.key)) {
            if (resume_walk()) continue;
            return true;
        }
        if (pair_walk.is_tested == 0u) {
            test_postponed();
        } else if (!is_leaf_word(pair_walk.word)) {
            choose_of_pair();
        } else {
            uint first = pair_walk.first;
            uint word = pair_walk.word;
            uint slot = pair_walk.slot;
            pair_walk.leaf = pair_walk.key;
            leave_pair();
            if (visit_leaf(first, word, slot)) return true;
        }
    }
    return false;
}

#endif
