// Restart trail with a short stack (after Laine 2010): no parents, no heap; what the stack has lost is found
// again from the root. The trail says which child is under way, so both ways down have to agree on which
// boxes are met and on their order, whatever hits have done to the ray in between: boxes are tested against
// the whole ray, and culled by the distance of entry afterwards. (The paper's rule, by which a single box
// that is met on the level of the last pop is the one already done, visits leaves twice where the hit has
// culled a box further up.) Trees of at most kTrailLevels32 or 64 levels. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_RESTART_TRAIL_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_RESTART_TRAIL_H
#endif

struct RestartState {
    uint root; ///< kNoNode: ended
    uint node;
    float entry;      ///< into the box of `node`
    Key trail, level; ///< levels as one bit each
    uint stack_top, stack_count;
};

RestartState restart_walk;
uint short_stack_nodes[kShortStackSize]; ///< a ring: the oldest entry makes room
float short_stack_entries[kShortStackSize];

/// `root_level`: make_root_level32 or 64; kNoNode: no tree.
RestartState start_restart_trail(uint root, Key root_level) {
    RestartState state = {root, root, 0.0f, root_level, root_level, 0u, 0u};
    if (root == kNoNode) return state;
    count_bytes(kNodeBytes);
    count_box_test();
    if (!(enter_whole_box(load_node(root)) < make_infinity())) state.root = kNoNode;
    return state;
}

/// A state that was saved without its stack goes on with an empty one.
RestartState drop_short_stack(RestartState state) {
    state.stack_count = 0u;
    return state;
}

void push_on_short_stack(uint node, float entry) {
    uint place = restart_walk.stack_top & (kShortStackSize - 1u);
    short_stack_nodes[place] = node;
    short_stack_entries[place] = entry;
    restart_walk.stack_top += 1u;
    restart_walk.stack_count = min_uint(restart_walk.stack_count + 1u, kShortStackSize);
}

/// Goes to what is due next: the entry on top of the stack, if any, is the sibling on that level.
void leave_level() {
    restart_walk.trail = pop_level(restart_walk.trail, restart_walk.level);
    if (is_root_finished(restart_walk.trail)) {
        restart_walk.root = kNoNode;
    } else if (restart_walk.stack_count > 0u) {
        restart_walk.stack_count -= 1u;
        restart_walk.stack_top -= 1u;
        uint place = restart_walk.stack_top & (kShortStackSize - 1u);
        restart_walk.node = short_stack_nodes[place];
        restart_walk.entry = short_stack_entries[place];
        restart_walk.level = get_lowest_bit(restart_walk.trail);
    } else {
        count_restart();
        restart_walk.node = restart_walk.root;
        restart_walk.entry = 0.0f;
        restart_walk.level = get_highest_bit(restart_walk.trail);
    }
}

void choose_child(uint first) {
    count_bytes(2u * kNodeBytes);
    count_box_test();
    count_box_test();
    float left = enter_whole_box(load_node(first));
    float right = enter_whole_box(load_node(first + 1u));
    float far_entry = max(left, right);
    uint near = first + (right < left ? 1u : 0u);
    uint far = first + first + 1u - near;
    restart_walk.level = shift_right(restart_walk.level, 1u);
    restart_walk.node = near;
    restart_walk.entry = min(left, right);
    if (!(far_entry < make_infinity())) {
        restart_walk.trail = join_bits(restart_walk.trail, restart_walk.level);
    } else if (has_common_bits(restart_walk.trail, restart_walk.level)) {
        restart_walk.node = far;
        restart_walk.entry = far_entry;
    } else {
        push_on_short_stack(far, far_entry);
    }
}

/// False where a device ends the loop too early.
bool walk_restart_trail() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (restart_walk.root == kNoNode) {
            if (resume_walk()) continue;
            return true;
        }
        // Where both children were missed, the entry is infinity, and so may be the limit.
        if (restart_walk.entry > get_limit() * kBoxSlack || !(restart_walk.entry < make_infinity())) {
            leave_level();
            continue;
        }
        uint node = restart_walk.node;
        TreeNode data = load_node(node);
        count_bytes(8u); // its box was read before
        if (!is_leaf_word(data.word)) {
            choose_child(data.first);
        } else {
            leave_level();
            if (visit_leaf(data.first, data.word, node)) return true;
        }
    }
    return false;
}

#endif
