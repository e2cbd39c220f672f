// The two scene trees in the structure and form that a traversal chosen by name walks: for either engine.
// What an engine walks by default has forms of its own (scene_trees.h).
#pragma once

#include "bvh/tree_links.h"
#include "lab/trees/heap_tree.h"
#include "lab/trees/sah_kdtree.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// One tree; what the traversal does not walk is empty.
struct WalkTree {
    LinkedBvh linked;       ///< stack, restart trail, parent link, skip link
    SuccinctHeap heap;      ///< trail, pair trail
    KdTree kd;              ///< restart, push-down, backtrack
    std::vector<Box> boxes; ///< of the primitives of a kd-tree, whose leaves have no box of their own
    Box bounds;             ///< of all primitives; empty: nothing in it

    int depth() const; ///< edges on the longest way down
    size_t byte_count() const;
};

/// At most scalar::kTrailLevels64 levels each.
struct WalkTrees {
    TraversalKind traversal = TraversalKind::automatic;
    std::vector<WalkTree> surfaces; ///< over the patches of each
    WalkTree instances;
    int depth = 0; ///< of the deepest: up to scalar::kTrailLevels32 keys and trails of 32 bits do

    size_t byte_count() const;
};

/// Of `settings` structure, traversal and sah_costs.
WalkTrees make_walk_trees(const PreparedScene& scene, const RenderSettings& settings, EngineKind engine);

} // namespace relief
