// The flat tree that every builder makes and every traversal reads: boxes and ids, no primitives.
#pragma once

#include <cstdint>
#include <vector>

#include "math/box.h"

namespace relief {

/// Edges on the longest way from the root of a Bvh to a leaf, for all builders: stacks have a fixed size.
inline constexpr int kMaxBvhDepth = 96;

/// 32 bytes. Children of an inner node are adjacent: `first` and `first + 1`.
struct BvhNode {
    Vec3f lower;
    uint32_t first = 0; ///< inner: index of the left child; leaf: first entry of Bvh::primitive_ids
    Vec3f upper;
    uint32_t primitive_count = 0; ///< 0: inner node

    bool is_leaf() const { return primitive_count > 0; }
    Box box() const { return {lower, upper}; }
};

/// Node 0 is the root; no nodes: no primitives.
struct Bvh {
    std::vector<BvhNode> nodes;
    std::vector<uint32_t> primitive_ids;
};

/// Throws Error{out_of_memory} for more than `most` primitives of a tree of that name.
void check_primitive_count(uint64_t count, uint64_t most, const char* tree, const char* hint);

} // namespace relief
