// Bit trail on a heap (Murguia et al. 2013): tests a node on arrival, then goes down, or to the next sibling
// due, by shifts. It may start at any node and visits every leaf once; ancestors' boxes are not tested. At
// most kTrailLevels32 or 64 levels. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_TRAIL_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_TRAIL_H
#endif

struct TrailState {
    Key key; ///< 0: ended
    Key trail;
    Key leaf; ///< of the leaf that was visited last: where the next ray may start
};

TrailState trail_walk;

/// 0: no tree.
TrailState start_trail(Key key) {
    TrailState state = {key, make_trail(key), key};
    return state;
}

/// False where a device ends the loop too early.
bool walk_trail() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (is_zero(trail_walk.key)) {
            if (resume_walk()) continue;
            return true;
        }
        uint slot = find_slot(trail_walk.key);
        TreeNode data = load_node(slot);
        count_bytes(kNodeBytes);
        count_box_test();
        bool is_met = enter_box(data) < make_infinity();
        if (is_met && !is_leaf_word(data.word)) {
            trail_walk.key = append_bit(trail_walk.key, is_axis_backward(get_word_axis(data.word)) ? 1u : 0u);
            trail_walk.trail = append_bit(trail_walk.trail, 0u);
            continue;
        }
        if (is_met) trail_walk.leaf = trail_walk.key;
        trail_walk.key = find_next_key(trail_walk.key, trail_walk.trail);
        trail_walk.trail = find_next_trail(trail_walk.trail);
        if (is_met && visit_leaf(data.first, data.word, slot)) return true;
    }
    return false;
}

#endif
