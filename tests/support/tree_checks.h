// What holds for every binary tree, and how two of them are compared.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "bvh/bvh.h"

namespace relief::test {

/// Children inside parents, each primitive in one leaf; at most `max_depth` levels below the root.
inline void expect_sound(const Bvh& bvh, const std::vector<Box>& boxes, uint32_t max_leaf_size,
                         int max_depth = kMaxBvhDepth) {
    struct Visit {
        uint32_t node;
        int depth;
    };
    std::vector<int> seen(boxes.size());
    std::vector<Visit> pending{{0, 0}};
    size_t node_count = 0;
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        ++node_count;
        ASSERT_LE(visit.depth, max_depth);
        ASSERT_LT(visit.node, bvh.nodes.size());
        const BvhNode& node = bvh.nodes[visit.node];
        if (!node.is_leaf()) {
            ASSERT_LT(node.first + 1, bvh.nodes.size());
            for (const uint32_t child : {node.first, node.first + 1}) {
                ASSERT_TRUE(node.box().contains(bvh.nodes[child].box()));
                pending.push_back({child, visit.depth + 1});
            }
            continue;
        }
        ASSERT_LE(node.primitive_count, max_leaf_size);
        for (uint32_t k = node.first; k < node.first + node.primitive_count; ++k) {
            ASSERT_LT(k, bvh.primitive_ids.size());
            ++seen[bvh.primitive_ids[k]];
            ASSERT_TRUE(node.box().contains(boxes[bvh.primitive_ids[k]]));
        }
    }
    EXPECT_EQ(node_count, bvh.nodes.size());
    for (const int times : seen) ASSERT_EQ(times, 1);
}

template <class T> bool is_same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool is_same(const Bvh& a, const Bvh& b) {
    return is_same_bytes(a.nodes, b.nodes) && a.primitive_ids == b.primitive_ids;
}

} // namespace relief::test
