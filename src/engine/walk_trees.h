// The two upper trees in the structure and form that a traversal chosen by name walks: for either engine.
// What an engine walks by default has forms of its own (scene_trees.h).
#pragma once

#include "engine/prepared_scene.h"
#include "structures/heap_tree.h"
#include "structures/sah_kdtree.h"
#include "structures/tree_links.h"

namespace relief {

/// One tree; what the traversal does not walk is empty.
struct WalkTree {
    LinkedBvh linked;       ///< stack, restart trail, parent link, skip link
    SuccinctHeap heap;      ///< trail, pair trail
    KdTree kd;              ///< restart, push-down, backtrack
    std::vector<Box> boxes; ///< of the primitives; kd-trees only, whose leaves have none
    Box bounds;             ///< empty: nothing in it

    /// Of what a traversal reads.
    size_t byte_count(TraversalKind traversal) const;
};

/// At most scalar::kTrailLevels32 levels each, but for kd-trees.
struct WalkTrees {
    TraversalKind traversal = TraversalKind::automatic;
    std::vector<WalkTree> surfaces; ///< over the patches of each
    WalkTree instances;

    size_t byte_count() const;
};

/// Boxes of the patches of a surface, in parallel.
std::vector<Box> compute_patch_boxes(const Surface& surface);

/// `traversal` goes with `structure` and is not automatic.
WalkTrees make_walk_trees(const PreparedScene& scene, StructureKind structure, TraversalKind traversal);

} // namespace relief
