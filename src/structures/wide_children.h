// Which nodes of a binary tree become the children of one eight-wide node: the same for every wide layout.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structures/bvh.h"

namespace relief {

inline constexpr int kMaxWideChildCount = 8;

/// Up to eight nodes of the binary tree, in its order.
struct WideChildren {
    std::array<uint32_t, kMaxWideChildCount> nodes{};
    int count = 0;
};

/// Leaves below each node. Children may come before or after their parents in memory.
std::vector<uint32_t> count_leaves(const Bvh& bvh);

/// Opens `root`, then always the child with the largest area (Wald, Benthin, Boulos 2008). A root that is a
/// leaf is its own only child.
WideChildren collect_wide_children(const Bvh& bvh, std::span<const uint32_t> leaf_counts, uint32_t root);

} // namespace relief
