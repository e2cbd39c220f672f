// Kd-tree, after every leaf up the parents to the first cell that the ray has not left yet (Foley and
// Sugerman 2005). A cell is left where the nearest of its planes is crossed, by the operations that the way
// down used; one without thickness would be left before it is entered, so the builder must make none. Cells
// are open where the root ends: the ray's end, which has slack, comes behind its faces, and other walks go on
// to that end. So this one visits the same leaves. Included as tree.h says.
#ifndef RELIEF_TRAVERSE_KD_BACKTRACK_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_KD_BACKTRACK_H
#endif

struct KdBacktrackState {
    KdRay ray;
    uint node;       ///< kNoNode: ended
    float near, far; ///< part of the ray inside `node` that is still to be walked
    uint is_climbing;
};

KdBacktrackState kd_backtrack_walk;

/// kNoNode: no tree.
KdBacktrackState start_kd_backtrack(uint root, KdRay ray) {
    KdBacktrackState state;
    state.ray = ray;
    state.node = ray.end < 0.0f ? kNoNode : root;
    state.near = 0.0f;
    state.far = ray.end;
    state.is_climbing = 0u;
    return state;
}

/// From a cell that the ray has left at `near`. The test of its planes is counted as that of a box; a way
/// down from a cell further up as a restart.
void climb_kd_cells() {
    KdBox box = load_kd_box(kd_backtrack_walk.node);
    count_bytes(kKdBoxBytes);
    count_box_test();
    float far = leave_cell(kd_backtrack_walk.ray, box.lower, box.upper, kd_backtrack_walk.ray.end);
    if (far > kd_backtrack_walk.near) {
        count_restart();
        kd_backtrack_walk.far = far;
        kd_backtrack_walk.is_climbing = 0u;
    } else {
        kd_backtrack_walk.node = box.parent;
    }
}

/// False where a device ends the loop too early.
bool walk_kd_backtrack() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (kd_backtrack_walk.node == kNoNode ||
            is_kd_walk_over(kd_backtrack_walk.ray, kd_backtrack_walk.near, get_limit())) {
            kd_backtrack_walk.node = kNoNode;
            if (resume_walk()) continue;
            return true;
        }
        if (kd_backtrack_walk.is_climbing != 0u) {
            climb_kd_cells();
            continue;
        }
        uint node = kd_backtrack_walk.node;
        KdNode data = load_kd_node(node);
        count_bytes(kKdNodeBytes);
        if ((data.word & 3u) != kKdLeaf) {
            KdStep step =
                step_down(kd_backtrack_walk.ray, node, data, kd_backtrack_walk.near, kd_backtrack_walk.far);
            kd_backtrack_walk.node = step.node;
            kd_backtrack_walk.far = step.far;
            continue;
        }
        // Up at once: the ray has left the leaf's own cell.
        kd_backtrack_walk.near = kd_backtrack_walk.far;
        kd_backtrack_walk.is_climbing = 1u;
        uint count = data.word >> 2u;
        if (count > 0u && visit_leaf(data.bits, count, node)) return true;
    }
    return false;
}

#endif
