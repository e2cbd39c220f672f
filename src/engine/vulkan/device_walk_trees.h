// Upper trees of a traversal chosen by name (engine/walk_trees.h) in device memory: nodes among the nodes,
// all else as words among the ids of primitives.
#pragma once

#include <vector>

#include "engine/vulkan/device_scene.h"
#include "engine/walk_trees.h"

namespace relief::vulkan {

/// Appends nodes, and writes records (shared/device_scene.h, WalkTreeData) and words into `words`, which must
/// be empty: record 0 is the tree of instances, 1 + s that of surface s.
void append_walk_trees(const WalkTrees& trees, std::vector<NodeTexels>& nodes, std::vector<uint32_t>& words);

} // namespace relief::vulkan
