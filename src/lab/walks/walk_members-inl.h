// The walks of lab/walks/traverse_*.h as members of one class, and which of them `kTraversal` stands for:
// only what that one uses is ever made. Included in the body of a class that has, besides, the hooks of
// formulas/tree.h, `Key`, and for kd-trees
// - KdRay make_own_kd_ray() const: the part of the ray inside the root's cell.

static constexpr bool kIsPushDown = kTraversal == TraversalKind::push_down;
static constexpr bool kIsBacktrack = kTraversal == TraversalKind::backtrack;
static constexpr bool kIsKd = kTraversal == TraversalKind::restart || kIsPushDown || kIsBacktrack;

#include "lab/walks/succinct_heap.h"
#include "lab/walks/traverse_kd.h"
#include "lab/walks/traverse_pair_trail.h"
#include "lab/walks/traverse_parent_link.h"
#include "lab/walks/traverse_restart_trail.h"
#include "lab/walks/traverse_skip_link.h"
#include "lab/walks/traverse_stack.h"
#include "lab/walks/traverse_trail.h"

static constexpr bool kIsWide = sizeof(Key) == sizeof(HeapKey);

static Key make_root_level() {
    if constexpr (kIsWide)
        return make_root_level64();
    else
        return make_root_level32();
}

/// From `root` (kNoNode: none), trails from the node of `key` (0: none). A stack keeps its contents.
void start_walk(uint root, Key key) {
    if constexpr (kTraversal == TraversalKind::stack)
        start_stack(root);
    else if constexpr (kTraversal == TraversalKind::restart_trail)
        restart_walk = start_restart_trail(root, make_root_level());
    else if constexpr (kTraversal == TraversalKind::parent_link)
        parent_walk = start_parent_link(root);
    else if constexpr (kTraversal == TraversalKind::skip_link)
        skip_walk = start_skip_link(root);
    else if constexpr (kTraversal == TraversalKind::trail)
        trail_walk = start_trail(key);
    else if constexpr (kTraversal == TraversalKind::pair_trail)
        pair_walk = start_pair_trail(key);
    else {
        static_assert(kIsKd);
        start_kd(root, make_own_kd_ray());
    }
}

/// False where a device ends the loop too early.
bool run_walk() {
    if constexpr (kTraversal == TraversalKind::stack)
        return walk_stack();
    else if constexpr (kTraversal == TraversalKind::restart_trail)
        return walk_restart_trail();
    else if constexpr (kTraversal == TraversalKind::parent_link)
        return walk_parent_link();
    else if constexpr (kTraversal == TraversalKind::skip_link)
        return walk_skip_link();
    else if constexpr (kTraversal == TraversalKind::trail)
        return walk_trail();
    else if constexpr (kTraversal == TraversalKind::pair_trail)
        return walk_pair_trail();
    else {
        static_assert(kIsKd);
        return walk_kd();
    }
}
