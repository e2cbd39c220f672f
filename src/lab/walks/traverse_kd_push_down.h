// Kd-tree, back after every leaf to the lowest node that holds all of the ray that is left (Horn et al.
// 2007): as long as a way down has met no plane that the ray crosses, the start moves down with it. Included
// as tree.h says.
#ifndef RELIEF_TRAVERSE_KD_PUSH_DOWN_H
#ifndef __cplusplus
#define RELIEF_TRAVERSE_KD_PUSH_DOWN_H
#endif

struct KdPushDownState {
    KdRay ray;
    uint start; ///< kNoNode: ended
    uint node;
    float near, far; ///< part of the ray inside `node` that is still to be walked
    uint is_pushing; ///< 1: no plane was crossed on this way down
};

KdPushDownState kd_push_down_walk;

/// kNoNode: no tree.
KdPushDownState start_kd_push_down(uint root, KdRay ray) {
    KdPushDownState state;
    state.ray = ray;
    state.start = ray.end < 0.0f ? kNoNode : root;
    state.node = root;
    state.near = 0.0f;
    state.far = ray.end;
    state.is_pushing = 1u;
    return state;
}

void restart_pushed_down() {
    kd_push_down_walk.near = kd_push_down_walk.far;
    kd_push_down_walk.far = kd_push_down_walk.ray.end;
    kd_push_down_walk.node = kd_push_down_walk.start;
    kd_push_down_walk.is_pushing = 1u;
    if (kd_push_down_walk.near < kd_push_down_walk.far)
        count_restart();
    else
        kd_push_down_walk.start = kNoNode;
}

/// False where a device ends the loop too early.
bool walk_kd_push_down() {
    for (uint round = 0u; round < kMostRounds; ++round) {
        if (kd_push_down_walk.start == kNoNode ||
            is_kd_walk_over(kd_push_down_walk.ray, kd_push_down_walk.near, get_limit())) {
            kd_push_down_walk.start = kNoNode;
            if (resume_walk()) continue;
            return true;
        }
        uint node = kd_push_down_walk.node;
        KdNode data = load_kd_node(node);
        count_bytes(kKdNodeBytes);
        if ((data.word & 3u) != kKdLeaf) {
            KdStep step =
                step_down(kd_push_down_walk.ray, node, data, kd_push_down_walk.near, kd_push_down_walk.far);
            kd_push_down_walk.node = step.node;
            kd_push_down_walk.far = step.far;
            if (step.is_split != 0u) kd_push_down_walk.is_pushing = 0u;
            if (kd_push_down_walk.is_pushing != 0u) kd_push_down_walk.start = step.node;
            continue;
        }
        restart_pushed_down();
        uint count = data.word >> 2u;
        if (count > 0u && visit_leaf(data.bits, count, node)) return true;
    }
    return false;
}

#endif
