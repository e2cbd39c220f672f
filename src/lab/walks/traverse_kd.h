// Kd-tree without a stack, in three forms that differ in what follows a leaf. Leaves come in the order of the
// ray; the hit counts that primitives report must be the nearest over all leaves so far, since a primitive
// may reach beyond the leaf it was found in. Included as tree.h says, after the constants kIsPushDown and
// kIsBacktrack.
// - Restart (Foley and Sugerman 2005): back to the root.
// - Push-down (Horn et al. 2007): back to the lowest node that holds all of the ray that is left. As long as
//   a way down has met no plane that the ray crosses, the start moves down with it.
// - Backtrack (Foley and Sugerman 2005): up the parents to the first cell that the ray has not left yet. A
//   cell is left where the nearest of its planes is crossed, by the operations that the way down used; one
//   without thickness would be left before it is entered, so the builder must make none. Cells are open where
//   the root ends: the ray's end, which has slack, comes behind its faces, and other forms go on to that end.
//   So this one visits the same leaves.
#ifndef RELIEF_TRAVERSE_KD_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_KD_H
#endif

struct KdState {
    KdRay ray;
    uint start; ///< where the next way down begins; kNoNode: ended
    uint node;
    float near, far;  ///< part of the ray inside `node` that is still to be walked
    uint is_pushing;  ///< push-down. 1: no plane was crossed on this way down
    uint is_climbing; ///< backtrack
};

KdState kd_walk;

/// kNoNode: no tree.
void start_kd(uint root, KdRay ray) {
    KdState state = {ray, ray.end < 0.0f ? kNoNode : root, root, 0.0f, ray.end, 1u, 0u};
    kd_walk = state;
}

/// From a cell that the ray left at `near`. Counts as a box test; from further up as a restart.
void climb_kd_cells() {
    KdBox box = load_kd_box(kd_walk.node);
    count_bytes(kKdBoxBytes);
    count_box_test();
    float far = leave_cell(kd_walk.ray, box.lower, box.upper, kd_walk.ray.end);
    if (far > kd_walk.near) {
        count_restart();
        kd_walk.far = far;
        kd_walk.is_climbing = 0u;
    } else {
        kd_walk.node = box.parent;
        if (box.parent == kNoNode) kd_walk.start = kNoNode;
    }
}

void restart_kd() {
    kd_walk.near = kd_walk.far;
    kd_walk.far = kd_walk.ray.end;
    kd_walk.node = kd_walk.start;
    kd_walk.is_pushing = 1u;
    if (kd_walk.near < kd_walk.far)
        count_restart();
    else
        kd_walk.start = kNoNode;
}

void leave_kd_leaf() {
    if (kIsBacktrack) {
        // Up at once: the ray has left the leaf's own cell.
        kd_walk.near = kd_walk.far;
        kd_walk.is_climbing = 1u;
    } else {
        restart_kd();
    }
}

void enter_kd_child(uint node, KdNode data) {
    KdStep step = step_down(kd_walk.ray, node, data, kd_walk.near, kd_walk.far);
    kd_walk.node = step.node;
    kd_walk.far = step.far;
    if (kIsPushDown) {
        if (step.is_split != 0u) kd_walk.is_pushing = 0u;
        if (kd_walk.is_pushing != 0u) kd_walk.start = step.node;
    }
}

/// False where a device ends the loop too early.
bool walk_kd() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (kd_walk.start == kNoNode || is_kd_walk_over(kd_walk.ray, kd_walk.near, get_limit())) {
            kd_walk.start = kNoNode;
            if (resume_walk()) continue;
            return true;
        }
        if (kIsBacktrack && kd_walk.is_climbing != 0u) {
            climb_kd_cells();
            continue;
        }
        uint node = kd_walk.node;
        KdNode data = load_kd_node(node);
        count_bytes(kKdNodeBytes);
        if ((data.word & 3u) != kKdLeaf) {
            enter_kd_child(node, data);
            continue;
        }
        leave_kd_leaf();
        uint count = data.word >> 2u;
        if (count > 0u && visit_leaf(data.bits, count, node)) return true;
    }
    return false;
}

#endif
