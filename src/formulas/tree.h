// Layouts of the trees that traverse_*.h traverse, and the hooks that those expect of their includer.
//
// traverse_*.h are loops, not formulas: GLSL includes them after declaring the hooks below, C++ in the body
// of a class with these members (lab/walks/walk_members-inl.h). Each has a state of a few words:
// start_x(root) initialises it, walk_x() resumes. It is advanced before a leaf is visited, so an instance can
// save it and start on another tree; resume_walk() restores it.
//
// Hooks of all traversals:
// - bool visit_leaf(uint first, uint word, uint node): tests the primitives of a leaf; true ends the
//   traversal.
// - bool resume_walk(): called when a tree is finished; true: another state has been restored.
// - float get_limit(): t_max of the ray, shortened by hits.
// - void count_box_test(), count_restart(), count_bytes(uint): empty where statistics are off. Bytes are
//   those of nodes, links and directories; primitives are counted by visit_leaf.
//
// Of traversals of BVHs:
// - TreeNode load_node(uint node): 32 bytes.
// - float enter_box(TreeNode node): entry distance; infinity: missed or beyond the limit. See cross_node.
// - float enter_whole_box(TreeNode node): the same for t_max before any hit. Restart trail only.
// - bool is_axis_backward(uint axis): whether the direction is negative. For the order of trail and parent
//   links.
// - Key: a type, uint or HeapKey, for trees of kTrailLevels32 or 64 levels. Trails and restart trail.
// - uint find_slot(Key key): location of the node with this key; siblings are adjacent. Trail, pair trail.
// - HeapForm get_heap_form(), HeapBlock load_heap_block(uint), HeapBrick load_heap_brick(uint), for
//   succinct_heap.h.
// - uint load_parent(uint node): 4 bytes. Parent links.
// - uint load_skip(uint node): 4 bytes; kNoNode behind the last. Skip links.
//
// Of kd-trees: KdNode load_kd_node(uint node), 8 bytes; KdBox load_kd_box(uint node), 32, backtrack only.
// `word` of visit_leaf is then the count alone.
#ifndef RELIEF_TREE_H
#define RELIEF_TREE_H
#include "formulas/constants.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"

#include "formulas/begin.h"

const uint kNoNode = 0xffffffffu;

/// Iteration limit of one traversal; a device may end its loops earlier, and then walk_x() returns false.
const uint kMostRounds = 0xffffffffu;

/// Entries of the full stack, and of the short one (a power of two).
const uint kTreeStackSize = 128u;
const uint kShortStackSize = 4u;

/// Where a parent-link traversal comes from.
const uint kFromParent = 0u;
const uint kFromSibling = 1u;
const uint kFromChild = 2u;

/// 32 bytes, the bits of relief::BvhNode. Children of an inner node are first and first + 1, the lower along
/// the axis first. A leaf's `first`, count and the highest four bits of its word are the includer's.
struct TreeNode {
    Vec3 lower;
    uint first;
    Vec3 upper;
    uint word; ///< bits 0 to 25: primitives, 26 and 27: axis of an inner node, 28 to 31: kind of a leaf
};
const uint kNodeBytes = 32u;
const uint kNodeCountMask = 0x03ffffffu;
const uint kNodeAxisShift = 26u;
const uint kNodeAxisMask = 0x0c000000u;
const uint kEmptySlot = 0xf3ffffffu; ///< word of an empty heap slot; never visited

FN bool is_leaf_word(const uint word) { return (word & ~kNodeAxisMask) != 0u; }
FN uint get_word_count(const uint word) { return word & kNodeCountMask; }
FN uint get_word_axis(const uint word) { return (word & kNodeAxisMask) >> kNodeAxisShift; }
FN uint make_inner_word(const uint axis) { return axis << kNodeAxisShift; }

/// Result of enter_box for a ray's interval.
FN float cross_node(const ObjectRay ray, const TreeNode node, const float t_min, const float t_max) {
    BoxInterval interval = cross_box(ray, node.lower, node.upper, t_min, t_max);
    return is_box_met(interval) ? interval.entry : make_infinity();
}

// Heap: slot k is the node of key k (slot 0 is empty). Siblings are one 64-byte line.
// Succinct heap: no empty slots. The root is slot 1; pairs of children follow in the order of their parents'
// keys. Flat part: a bit for each key below 2^(flat_levels + 1), set for inner nodes; its rank is the number
// of the pair, or on the last level the number of a brick. A brick stands for six levels: bit i of `inner` is
// its inner node of local key i (1 to 63), ranked from first_pair; bit i of `deeper`: the node of local key
// 64 + i has a brick, ranked from first_brick.

/// 64 keys of the flat part.
struct HeapBlock {
    uint inner_low, inner_high;
    uint rank; ///< bits set in the blocks before
};

struct HeapBrick {
    uint inner_low, inner_high, first_pair;
    uint deeper_low, deeper_high, first_brick;
};

struct HeapForm {
    uint flat_levels;
    uint flat_pairs; ///< pairs before those of the first brick
};
const uint kHeapBlockBytes = 12u;
const uint kHeapBrickBytes = 24u;
const uint kBrickLevels = 6u;

/// Bits set below bit `place` (0 to 63).
FN uint rank_bits(const uint low, const uint high, const uint place) {
    if (place < 32u) return uint(bitCount(low & ((1u << place) - 1u)));
    return uint(bitCount(low)) + uint(bitCount(high & ((1u << (place - 32u)) - 1u)));
}

/// Kd-tree, 8 bytes: inner: `bits` is the plane as a float, the left child follows its parent, word = right
/// child << 2 | axis; leaf: `bits` is the first entry of the ids, word = count << 2 | 3; a leaf may be empty.
struct KdNode {
    uint bits;
    uint word;
};
const uint kKdNodeBytes = 8u;
const uint kKdLeaf = 3u;

/// Cell of a node, for the way back, open where the root ends; kNoNode above the root.
struct KdBox {
    Vec3 lower;
    uint parent;
    Vec3 upper;
    uint unused; ///< 0; keeps records to 32 bytes
};
const uint kKdBoxBytes = 32u;

/// Part of a ray inside the root's cell; t counts from the entry point for precision: t = own t + offset.
struct KdRay {
    Vec3 origin;
    Vec3 direction;
    float offset;
    float end; ///< negative: the cell is missed
};

/// 2 - kBoxSlack. A literal, because shader compilers fold constants in double precision.
const float kCellSlack = 0.99999845f;

FN KdRay make_kd_ray(const ObjectRay ray, const Vec3 lower, const Vec3 upper, const float t_min,
                     const float t_max) {
    BoxInterval interval = cross_box(ray, lower, upper, t_min, t_max);
    // Never beyond the face: far from the origin, the float spacing exceeds the cell's margin.
    EXACT float offset = interval.entry * kCellSlack;
    EXACT float end = interval.exit * kBoxSlack - offset;
    EXACT float way = offset - ray.shift;
    Vec3 origin = {move_origin(ray.origin.x, ray.direction.x, way),
                   move_origin(ray.origin.y, ray.direction.y, way),
                   move_origin(ray.origin.z, ray.direction.z, way)};
    KdRay result;
    result.direction = ray.direction;
    result.origin = offset > 0.0f ? origin : ray.origin;
    result.offset = offset;
    result.end = is_box_met(interval) ? max(end, 0.0f) : -1.0f;
    return result;
}

/// Where the ray crosses the plane; only for a direction that is not zero along the axis.
FN float cross_plane(const KdRay ray, const uint axis, const float plane) {
    EXACT float t = (plane - select_axis(ray.origin, axis)) / select_axis(ray.direction, axis);
    return t;
}

/// One step down: the child to visit, and the end of the ray's interval in it.
struct KdStep {
    uint node;
    float far;
    uint is_split; ///< 1: the other child follows
};

/// Descends from inner node `node`, inside of which the ray is from `near` to `far`. At near == plane the ray
/// counts as beyond the plane: otherwise a traversal that restarts there would not advance.
FN KdStep step_down(const KdRay ray, const uint node, const KdNode data, const float near, float far) {
    uint axis = data.word & 3u;
    float plane = uintBitsToFloat(data.bits);
    uint left = node + 1u;
    uint right = data.word >> 2u;
    float speed = select_axis(ray.direction, axis);
    KdStep step = {left, far, 0u};
    if (speed == 0.0f) {
        step.node = select_axis(ray.origin, axis) <= plane ? left : right;
        return step;
    }
    float t = cross_plane(ray, axis, plane);
    uint first = speed > 0.0f ? left : right;
    step.node = t <= near ? left + right - first : first;
    if (t > near && t < far) {
        step.far = t;
        step.is_split = 1u;
    }
    return step;
}

/// Exit distance from a cell, with the same operations as cross_plane of its planes.
FN float leave_cell(const KdRay ray, const Vec3 lower, const Vec3 upper, float far) {
    if (ray.direction.x != 0.0f)
        far = min(far, cross_plane(ray, 0u, ray.direction.x > 0.0f ? upper.x : lower.x));
    if (ray.direction.y != 0.0f)
        far = min(far, cross_plane(ray, 1u, ray.direction.y > 0.0f ? upper.y : lower.y));
    if (ray.direction.z != 0.0f)
        far = min(far, cross_plane(ray, 2u, ray.direction.z > 0.0f ? upper.z : lower.z));
    return far;
}

/// Whether `near` lies beyond the nearest hit, with a margin for the rounding of both.
FN bool is_kd_walk_over(const KdRay ray, const float near, const float t_max) {
    EXACT float reach = t_max * kBoxSlack;
    EXACT float place = near + ray.offset;
    return place > reach;
}

#include "formulas/end.h"
#endif
