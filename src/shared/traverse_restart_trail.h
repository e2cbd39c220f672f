// Restart trail with a short stack (Laine 2010): no parents, no heap; what the stack has lost is found again
// from the root. Children are ordered by the distance of entry: the walk relies on it that a box which a hit
// has culled was the farther one. Trees of at most kTrailLevels32 or 64 levels. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_RESTART_TRAIL_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_RESTART_TRAIL_H
#endif

struct RestartState {
    uint root; ///< kNoNode: ended
    uint node;
    Key trail, level, popped; ///< levels as one bit each; popped: where the walk last came up to
    uint stack_top, stack_count;
};

RestartState restart_walk;
uint short_stack[kShortStackSize]; ///< a ring: the oldest entry makes room

/// `root_level`: make_root_level32 or 64; kNoNode: no tree.
RestartState start_restart_trail(uint root, Key root_level) {
    RestartState state;
    state.root = root;
    state.node = root;
    state.trail = root_level;
    state.level = root_level;
    state.popped = pop_level(root_level, root_level); // no level
    state.stack_top = 0u;
    state.stack_count = 0u;
    return state;
}

/// A state that was saved without its stack goes on with an empty one.
RestartState drop_short_stack(RestartState state) {
    state.stack_count = 0u;
    return state;
}

void push_on_short_stack(uint node) {
    short_stack[restart_walk.stack_top & (kShortStackSize - 1u)] = node;
    restart_walk.stack_top += 1u;
    restart_walk.stack_count = min_uint(restart_walk.stack_count + 1u, kShortStackSize);
}

void leave_level() {
    restart_walk.trail = pop_level(restart_walk.trail, restart_walk.level);
    if (is_root_finished(restart_walk.trail)) {
        restart_walk.root = kNoNode;
        return;
    }
    restart_walk.popped = lowest_bit(restart_walk.trail);
    if (restart_walk.stack_count > 0u) {
        restart_walk.stack_count -= 1u;
        restart_walk.stack_top -= 1u;
        restart_walk.node = short_stack[restart_walk.stack_top & (kShortStackSize - 1u)];
        restart_walk.level = restart_walk.popped;
        return;
    }
    count_restart();
    restart_walk.node = restart_walk.root;
    restart_walk.level = highest_bit(restart_walk.trail);
}

/// At an inner node whose box was met.
void choose_child(uint first) {
    count_bytes(2u * kNodeBytes);
    count_box_test();
    count_box_test();
    float left = enter_box(load_node(first));
    float right = enter_box(load_node(first + 1u));
    bool is_right_nearer = right < left;
    uint near = first + (is_right_nearer ? 1u : 0u);
    uint far = first + first + 1u - near;
    if (!(min(left, right) < make_infinity())) {
        leave_level();
        return;
    }
    restart_walk.level = shift_right(restart_walk.level, 1u);
    restart_walk.node = near;
    if (max(left, right) < make_infinity()) {
        if (has_common_bits(restart_walk.trail, restart_walk.level))
            restart_walk.node = far;
        else
            push_on_short_stack(far);
    } else if (is_equal(restart_walk.level, restart_walk.popped)) {
        leave_level(); // the far child was due, and a hit has culled it
    } else {
        restart_walk.trail = join_bits(restart_walk.trail, restart_walk.level);
    }
}

/// False where a device ends the loop too early.
bool walk_restart_trail() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (restart_walk.root == kNoNode) {
            if (resume_walk()) continue;
            return true;
        }
        uint node = restart_walk.node;
        TreeNode data = load_node(node);
        count_bytes(kNodeBytes);
        count_box_test();
        if (!(enter_box(data) < make_infinity())) {
            leave_level();
        } else if (!is_leaf_word(data.word)) {
            choose_child(data.first);
        } else {
            leave_level();
            if (visit_leaf(data.first, data.word, node)) return true;
        }
    }
    return false;
}

#endif
