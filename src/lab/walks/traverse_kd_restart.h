// Kd-tree, back to the root after every leaf (Foley and Sugerman 2005). Leaves come in the order of the ray.
// Included as tree.h says; the hit counts that primitives report must be the nearest over all leaves so far,
// since a primitive may reach beyond the leaf it was found in.
#ifndef RELIEF_TRAVERSE_KD_RESTART_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_KD_RESTART_H
#endif

struct KdRestartState {
    KdRay ray;
    uint root; ///< kNoNode: ended
    uint node;
    float near, far; ///< part of the ray inside `node` that is still to be walked
};

KdRestartState kd_restart_walk;

/// kNoNode: no tree.
KdRestartState start_kd_restart(uint root, KdRay ray) {
    KdRestartState state;
    state.ray = ray;
    state.root = ray.end < 0.0f ? kNoNode : root;
    state.node = root;
    state.near = 0.0f;
    state.far = ray.end;
    return state;
}

void restart_kd_walk() {
    kd_restart_walk.near = kd_restart_walk.far;
    kd_restart_walk.far = kd_restart_walk.ray.end;
    kd_restart_walk.node = kd_restart_walk.root;
    if (kd_restart_walk.near < kd_restart_walk.far)
        count_restart();
    else
        kd_restart_walk.root = kNoNode;
}

/// False where a device ends the loop too early.
bool walk_kd_restart() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (kd_restart_walk.root == kNoNode ||
            is_kd_walk_over(kd_restart_walk.ray, kd_restart_walk.near, get_limit())) {
            kd_restart_walk.root = kNoNode;
            if (resume_walk()) continue;
            return true;
        }
        uint node = kd_restart_walk.node;
        KdNode data = load_kd_node(node);
        count_bytes(kKdNodeBytes);
        if ((data.word & 3u) != kKdLeaf) {
            KdStep step =
                step_down(kd_restart_walk.ray, node, data, kd_restart_walk.near, kd_restart_walk.far);
            kd_restart_walk.node = step.node;
            kd_restart_walk.far = step.far;
            continue;
        }
        restart_kd_walk();
        uint count = data.word >> 2u;
        if (count > 0u && visit_leaf(data.bits, count, node)) return true;
    }
    return false;
}

#endif
