// A scene traversal in place of the engine's own: src/lab has those of papers 2 and 3.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relief/types.h"

namespace relief::vulkan {

/// A node of a tree over tiles, or of another traversal than the engine's own: two texels.
struct NodeTexels {
    Vec3f lower;
    uint32_t first;
    Vec3f upper;
    uint32_t kind_and_count;
};
static_assert(sizeof(NodeTexels) == 32);

/// A shader with its SPIR-V; empty SPIR-V: the shader of that name in vulkan/shaders.
struct TraversalKernel {
    std::string shader;
    std::span<const uint32_t> compute, fragment;
};

/// Scene trees and the kernel that traverses them.
struct SceneWalk {
    std::vector<NodeTexels> nodes;    ///< for kBindNodes
    std::vector<uint32_t> words;      ///< for kBindPrimitiveIds
    std::vector<uint8_t> has_patches; ///< one per surface
    bool has_instances = false;
    TraversalKernel kernel;
};

} // namespace relief::vulkan
