// Hooks of formulas/tree.h for trees of boxes. Included by tree_walk.glsl.
layout(set = 0, binding = kBindTreeNodes) uniform usamplerBuffer tree_nodes;

TreeNode load_node(const uint node) {
    uvec4 low = texelFetch(tree_nodes, int(2u * node));
    uvec4 high = texelFetch(tree_nodes, int(2u * node + 1u));
    return TreeNode(uintBitsToFloat(low.xyz), low.w, uintBitsToFloat(high.xyz), high.w);
}

float enter_box(const TreeNode node) { return cross_node(walk_ray, node, walk_t_min, walk_best.t); }

#if defined(WALK_RESTART_TRAIL)
float enter_whole_box(const TreeNode node) { return cross_node(walk_ray, node, walk_t_min, walk_t_max); }
#endif

bool is_axis_backward(const uint axis) { return select_axis(walk_ray.direction, axis) < 0.0; }

#if defined(WALK_PARENT_LINK)
layout(set = 0, binding = kBindTreeParents) uniform usamplerBuffer tree_parents;
uint load_parent(const uint node) { return texelFetch(tree_parents, int(node)).x; }
#endif

#if defined(WALK_SKIP_LINK)
layout(set = 0, binding = kBindTreeSkips) uniform usamplerBuffer tree_skips;
uint load_skip(const uint node) { return texelFetch(tree_skips, int(node)).x; }
#endif

#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
layout(scalar, set = 0, binding = kBindHeapBlocks) readonly buffer HeapBlocks { HeapBlock heap_blocks[]; };
layout(scalar, set = 0, binding = kBindHeapBricks) readonly buffer HeapBricks { HeapBrick heap_bricks[]; };

HeapForm get_heap_form() { return HeapForm(push.flat_levels, push.flat_pairs); }
HeapBlock load_heap_block(const uint block) { return heap_blocks[block]; }
HeapBrick load_heap_brick(const uint brick) { return heap_bricks[brick]; }
#include "lab/walks/succinct_heap.h"

uint find_slot(const Key key) {
    if (kIsSuccinct == 0u) return get_low_word(key);
    return find_succinct_slot(key);
}

uint narrow_key(const HeapKey key, const uint width) { return key.low; }
HeapKey narrow_key(const HeapKey key, const HeapKey width) { return key; }
Key narrow_key(const HeapKey key) {
    Key width;
    return narrow_key(key, width);
}
HeapKey widen_key(const uint key) { return HeapKey(key, 0u); }
HeapKey widen_key(const HeapKey key) { return key; }
#endif
