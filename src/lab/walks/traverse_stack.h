// Full stack, nearer child first. It may hold several trees, each above its begin. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_STACK_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_STACK_H
#endif

struct StackState {
    uint first; ///< entries below are another tree's
    uint count;
};

StackState stack_walk;
uint stack_nodes[kTreeStackSize];
float stack_entries[kTreeStackSize];

void push_on_stack(uint node, float entry) {
    stack_nodes[stack_walk.count] = node;
    stack_entries[stack_walk.count] = entry;
    stack_walk.count += 1u;
}

StackState make_empty_stack() {
    StackState state = {0u, 0u};
    return state;
}

/// On top of what the stack holds (at first: make_empty_stack); kNoNode: no tree.
void start_stack(uint root) {
    stack_walk.first = stack_walk.count;
    if (root == kNoNode) return;
    count_bytes(kNodeBytes);
    count_box_test();
    float entry = enter_box(load_node(root));
    if (entry < make_infinity()) push_on_stack(root, entry);
}

void push_children(uint first) {
    count_bytes(2u * kNodeBytes);
    count_box_test();
    count_box_test();
    float left = enter_box(load_node(first));
    float right = enter_box(load_node(first + 1u));
    bool is_right_nearer = right < left;
    uint near = first + (is_right_nearer ? 1u : 0u);
    float near_entry = is_right_nearer ? right : left;
    float far_entry = is_right_nearer ? left : right;
    if (far_entry < make_infinity()) push_on_stack(first + first + 1u - near, far_entry);
    if (near_entry < make_infinity()) push_on_stack(near, near_entry);
}

/// False where a device ends the loop too early.
bool walk_stack() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (stack_walk.count == stack_walk.first) {
            if (resume_walk()) continue;
            return true;
        }
        stack_walk.count -= 1u;
        // The limit may have come nearer since the entry was pushed.
        if (stack_entries[stack_walk.count] > get_limit() * kBoxSlack) continue;
        uint node = stack_nodes[stack_walk.count];
        TreeNode data = load_node(node);
        count_bytes(8u); // its box was read before
        if (!is_leaf_word(data.word))
            push_children(data.first);
        else if (visit_leaf(data.first, data.word, node))
            return true;
    }
    return false;
}

#endif
