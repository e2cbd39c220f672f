// Single rays through the two upper trees by a traversal chosen by name: the loops of shared/traverse_*.h,
// which the kernels of a device run too. Not tuned as the wide trees are.
#pragma once

#include <cstddef>

#include "engine/cpu/kernels.h"
#include "engine/walk_trees.h"

namespace relief::cpu {

/// What such a walk reads besides the scene.
struct WalkView {
    const SceneView& scene;
    const WalkTrees& trees;
    PrimitiveKernels primitive;
};

/// As those of Kernels.
struct WalkFunctions {
    void (*closest_hits)(const WalkView&, TraceContext&, const TraceRay*, TraceHit*, size_t count);
    void (*any_hits)(const WalkView&, TraceContext&, const TraceRay*, uint8_t*, size_t count);
};

/// Any traversal but automatic and wide, over trees of `depth` levels at most.
WalkFunctions find_walk(TraversalKind traversal, int depth);

} // namespace relief::cpu
