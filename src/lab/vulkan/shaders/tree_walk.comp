// Rays of a buffer through one tree; compiled once a traversal (variants.cmake).
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/tree_walk.glsl"

layout(scalar, set = 0, binding = kBindTreeRays) readonly buffer Rays { TreeRay rays[]; };
layout(scalar, set = 0, binding = kBindTreeHits) writeonly buffer Hits { TreeHit hits[]; };
layout(scalar, set = 0, binding = kBindWalkCounts) writeonly buffer Counts { RayCounts counts[]; };
layout(scalar, set = 0, binding = kBindWalkState) buffer State { WalkState state; };

#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
layout(scalar, set = 0, binding = kBindStartKeys) readonly buffer StartKeys { HeapKey start_keys[]; };
layout(scalar, set = 0, binding = kBindLeafKeys) writeonly buffer LeafKeys { HeapKey leaf_keys[]; };

void choose_start(const uint ray) {
    HeapKey root = HeapKey(push.root, 0u);
    HeapKey start = root;
    if (push.has_start_keys != 0u) start = start_keys[ray];
    walk_start = narrow_key(is_zero(root) ? root : start);
    walk_hit_leaf = narrow_key(start);
}

void keep_leaf(const uint ray) {
    if (push.has_leaf_keys != 0u) leaf_keys[ray] = widen_key(walk_hit_leaf);
}
#else
void choose_start(const uint ray) {}
void keep_leaf(const uint ray) {}
#endif

void main() {
    uint ray = invocation_index();
    if (ray >= push.ray_count) return;
    begin_walk(rays[ray]);
    choose_start(ray);
    if (!walk_tree()) atomicAdd(state.rays_lost, 1u);
    TreeHit hit = walk_best;
    if (hit.primitive == kNone) hit.t = make_infinity();
    hits[ray] = hit;
    if (kIsCounting != 0u) counts[ray] = walk_counts;
    keep_leaf(ray);
}
