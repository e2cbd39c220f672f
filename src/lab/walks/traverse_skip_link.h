// Skip links: down to the left child where a box is met, else to the node that follows the whole subtree. One
// word of state, every box tested at most once, no order from front to back. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_SKIP_LINK_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_SKIP_LINK_H
#endif

struct SkipLinkState {
    uint node; ///< kNoNode: ended
};

SkipLinkState skip_walk;

/// kNoNode: no tree.
SkipLinkState start_skip_link(uint root) {
    SkipLinkState state = {root};
    return state;
}

/// False where a device ends the loop too early.
bool walk_skip_link() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (skip_walk.node == kNoNode) {
            if (resume_walk()) continue;
            return true;
        }
        uint node = skip_walk.node;
        TreeNode data = load_node(node);
        count_bytes(kNodeBytes);
        count_box_test();
        bool is_met = enter_box(data) < make_infinity();
        if (is_met && !is_leaf_word(data.word)) {
            skip_walk.node = data.first;
            continue;
        }
        count_bytes(4u);
        skip_walk.node = load_skip(node);
        if (is_met && visit_leaf(data.first, data.word, node)) return true;
    }
    return false;
}

#endif
