// One ray through the two upper levels by a named traversal (variants.cmake). A leaf of the instances' tree replaces
// the walk by a surface's; at its end resume_walk() goes on with the leaf's next instance or the old walk.
#include "vulkan/shaders/kernel.glsl"

#ifdef WALK_KD
const bool kMayOfferTwice = true; // a patch has entries in several leaves
#else
const bool kMayOfferTwice = false;
#endif
#include "vulkan/shaders/scene_candidates.glsl"
#include "vulkan/shaders/tile_walk.glsl"
#include "lab/walks/trail.h"
#include "formulas/tree.h"

WalkTreeData tree;    ///< that is walked
float instance_entry; ///< into the box of the instance, for the order of candidates
uint waiting_first;   ///< instances of the leaf that are still to be entered, as words
uint waiting_count = 0u;
float waiting_entry; ///< into the box of their leaf

uint load_word(const uint word) { return texelFetch(primitive_ids, int(word)).x; }
vec3 load_word_vector(const uint word) {
    return vec3(uintBitsToFloat(load_word(word)), uintBitsToFloat(load_word(word + 1u)),
                uintBitsToFloat(load_word(word + 2u)));
}

/// 0: of the instances, 1 + s: of surface s.
WalkTreeData load_walk_tree(const uint index) {
    uint word = kWalkTreeWords * index;
    return WalkTreeData(load_word_vector(word), load_word_vector(word + 3u), load_word(word + 6u),
                        load_word(word + 7u), load_word(word + 8u), load_word(word + 9u), load_word(word + 10u),
                        load_word(word + 11u), load_word(word + 12u), load_word(word + 13u));
}

TreeNode load_any_node(const uint place) {
    uvec4 low = texelFetch(nodes, 2 * int(place));
    uvec4 high = texelFetch(nodes, 2 * int(place) + 1);
    return TreeNode(uintBitsToFloat(low.xyz), low.w, uintBitsToFloat(high.xyz), high.w);
}

BoxInterval cross_tree_box(const TreeNode node) {
    return cross_box(ray, node.lower, node.upper, ray_t_min, ray_t_max);
}

/// Infinity where nothing in the box is wanted.
float enter_wanted_box(const TreeNode node) {
    BoxInterval interval = cross_tree_box(node);
    float entry = max(interval.entry, instance_entry);
    return is_wanted(interval, entry) ? entry : kInfinity;
}

// The hooks of formulas/tree.h.
bool visit_leaf(const uint first, const uint word, const uint node);
bool resume_walk();
void count_box_test() {}
void count_restart() {}
void count_bytes(const uint bytes) {}
float get_limit() { return find_limit(); }
#ifdef WALK_KD
KdNode load_kd_node(const uint node) {
    return KdNode(load_word(tree.links + 2u * node), load_word(tree.links + 2u * node + 1u));
}
KdBox load_kd_box(const uint node) {
    TreeNode cell = load_any_node(tree.nodes + node);
    return KdBox(cell.lower, cell.first, cell.upper, cell.word);
}
KdRay enter_root_cell() { return make_kd_ray(ray, tree.lower, tree.upper, ray_t_min, best_t); }
#else
TreeNode load_node(const uint node) { return load_any_node(tree.nodes + node); }
float enter_box(const TreeNode node) { return enter_wanted_box(node); }
float enter_whole_box(const TreeNode node) {
    BoxInterval interval = cross_tree_box(node);
    float entry = max(interval.entry, instance_entry);
    return is_wanted_at_all(interval, entry) ? entry : kInfinity;
}
bool is_axis_backward(const uint axis) { return select_axis(ray.direction, axis) < 0.0; }
uint load_parent(const uint node) { return load_word(tree.links + node); }
uint load_skip(const uint node) { return load_word(tree.links + node); }
#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
HeapForm get_heap_form() { return HeapForm(tree.flat_levels, tree.flat_pairs); }
HeapBlock load_heap_block(const uint block) {
    uint word = tree.links + 3u * block;
    return HeapBlock(load_word(word), load_word(word + 1u), load_word(word + 2u));
}
HeapBrick load_heap_brick(const uint brick) {
    uint word = tree.bricks + 6u * brick;
    return HeapBrick(load_word(word), load_word(word + 1u), load_word(word + 2u), load_word(word + 3u),
                     load_word(word + 4u), load_word(word + 5u));
}
#include "lab/walks/succinct_heap.h"
uint find_slot(const Key key) { return find_succinct_slot(key); }
#endif
#endif
#include "lab/vulkan/shaders/walk_kind.glsl"

#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
// The key of the root in each width; the macro Key picks one by the type of the argument.
uint make_root_key(const uint width) { return 1u; }
HeapKey make_root_key(const HeapKey width) { return HeapKey(1u, 0u); }
Key find_root() {
    Key width;
    return make_root_key(width);
}
#else
uint find_root() { return 0u; }
#endif

KindState world_state; ///< of the tree of instances, past the leaf whose instances are entered

/// Where the ray enters primitive `id`, the same in all leaves; infinity where nothing in its box is wanted.
float enter_primitive(const uint id, const float leaf_entry) {
#ifdef WALK_KD
    return enter_wanted_box(load_any_node(tree.boxes + id));
#else
    return leaf_entry;
#endif
}

/// Before the first hit the limit is infinite, too, and infinity still means a missed box.
bool is_within_limit(const float entry) { return entry < kInfinity && entry <= find_limit(); }

float enter_leaf(const uint node) {
#ifdef WALK_KD
    return 0.0;
#else
    return max(cross_tree_box(load_node(node)).entry, instance_entry);
#endif
}

/// In world space, `tree` that of the instances. False: none left. (`continue` loses lanes on lavapipe 22.3.)
bool enter_next_instance() {
    bool is_entered = false;
    while (waiting_count > 0u && !is_entered) {
        uint index = load_word(waiting_first);
        ++waiting_first;
        --waiting_count;
        float entry = enter_primitive(index, waiting_entry);
        is_entered = is_instance_seen(index) && is_within_limit(entry);
        if (is_entered) {
            enter_instance(index);
            instance_entry = entry;
            tree = load_walk_tree(1u + instances[instance_index].surface);
            start_walk(find_root());
        }
    }
    return is_entered;
}

bool visit_leaf(const uint first, const uint word, const uint node) {
    uint count = get_word_count(word);
    float leaf_entry = enter_leaf(node);
    if (instance_index == kNone) {
        waiting_first = tree.ids + first;
        waiting_count = count;
        waiting_entry = leaf_entry;
        world_state = walk_state;
        enter_next_instance();
        return false;
    }
    bool has_displacement = surfaces[instances[instance_index].surface].map != kNone;
    for (uint k = 0u; k < count; ++k) {
        uint patch_index = load_word(tree.ids + first + k);
        if (has_displacement) {
            float entry = enter_primitive(patch_index, leaf_entry);
            if (is_within_limit(entry)) enter_patch(patch_index, entry);
        } else {
            intersect_polygon(patch_index);
        }
    }
    return push.is_any != 0u && has_hit;
}

bool resume_walk() {
    if (instance_index == kNone) return false;
    leave_instance();
    instance_entry = ray_t_min;
    tree = load_walk_tree(0u);
    if (enter_next_instance()) return true;
    walk_state = world_state;
#ifdef WALK_RESTART_TRAIL
    walk_state = drop_short_stack(walk_state);
#endif
    return true;
}

bool walk() {
    leave_instance();
    instance_entry = ray_t_min;
    tree = load_walk_tree(0u);
#ifdef WALK_STACK
    stack_walk = make_empty_stack();
#endif
    start_walk(find_root());
    return walk_on();
}

void main() { trace_round(); }
