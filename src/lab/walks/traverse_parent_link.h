// Parent links (Hapala et al. 2011, Efficient Stack-less BVH Traversal): an automaton of three states. On the
// way up it has to know which child came first, hence an order by axis. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_PARENT_LINK_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_PARENT_LINK_H
#endif

struct ParentLinkState {
    uint root; ///< kNoNode: ended
    uint node;
    uint from;
    uint pair; ///< from parent or sibling: the left one of the node and its sibling
};

ParentLinkState parent_walk;

/// kNoNode: no tree.
ParentLinkState start_parent_link(uint root) {
    ParentLinkState state = {root, root, kFromParent, root};
    return state;
}

uint find_near_child(TreeNode data) {
    return data.first + (is_axis_backward(get_word_axis(data.word)) ? 1u : 0u);
}

void go_to_sibling(uint pair) {
    parent_walk.node = pair + pair + 1u - parent_walk.node;
    parent_walk.from = kFromSibling;
    parent_walk.pair = pair;
}

/// After the node was missed, or before it is visited as a leaf.
void leave_node() {
    if (parent_walk.node == parent_walk.root) {
        parent_walk.root = kNoNode;
    } else if (parent_walk.from == kFromParent) {
        go_to_sibling(parent_walk.pair);
    } else {
        count_bytes(4u);
        parent_walk.node = load_parent(parent_walk.node);
        parent_walk.from = kFromChild;
    }
}

void climb_to_parent() {
    if (parent_walk.node == parent_walk.root) {
        parent_walk.root = kNoNode;
        return;
    }
    uint parent = load_parent(parent_walk.node);
    TreeNode data = load_node(parent);
    count_bytes(4u + kNodeBytes);
    if (parent_walk.node == find_near_child(data))
        go_to_sibling(data.first);
    else
        parent_walk.node = parent;
}

/// False where a device ends the loop too early.
bool walk_parent_link() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (parent_walk.root == kNoNode) {
            if (resume_walk()) continue;
            return true;
        }
        if (parent_walk.from == kFromChild) {
            climb_to_parent();
            continue;
        }
        uint node = parent_walk.node;
        TreeNode data = load_node(node);
        count_bytes(kNodeBytes);
        count_box_test();
        bool is_met = enter_box(data) < make_infinity();
        if (is_met && !is_leaf_word(data.word)) {
            parent_walk.node = find_near_child(data);
            parent_walk.from = kFromParent;
            parent_walk.pair = data.first;
            continue;
        }
        leave_node();
        if (is_met && visit_leaf(data.first, data.word, node)) return true;
    }
    return false;
}

#endif
