#include "bvh/wide_children.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bvh/sah_bvh.h"
#include "bvh/sah_split.h"
#include "support/box_sets.h"

namespace relief {
namespace {

/// As a share of the root's.
double find_area(const Bvh& bvh, uint32_t node) {
    const double whole = compute_half_area(bvh.nodes[0].box());
    return whole > 0 ? compute_half_area(bvh.nodes[node].box()) / whole : 0;
}

/// Every way to cut a subtree into nodes that fill at most `slots`, by the area of the wide nodes below.
std::vector<double> list_cuts(const Bvh& bvh, uint32_t node, int slots, double node_cost);

double find_least(const Bvh& bvh, uint32_t root, double node_cost) {
    const BvhNode& node = bvh.nodes[root];
    double best = std::numeric_limits<double>::infinity();
    for (int left = 1; left < kMaxWideChildCount; ++left) {
        const auto a = list_cuts(bvh, node.first, left, node_cost);
        const auto b = list_cuts(bvh, node.first + 1, kMaxWideChildCount - left, node_cost);
        best = std::min(best, *std::min_element(a.begin(), a.end()) + *std::min_element(b.begin(), b.end()));
    }
    return node_cost + find_area(bvh, root) + best;
}

std::vector<double> list_cuts(const Bvh& bvh, uint32_t node, int slots, double node_cost) {
    if (bvh.nodes[node].is_leaf()) return {0};
    std::vector<double> cuts{find_least(bvh, node, node_cost)};
    for (int left = 1; left < slots; ++left)
        for (const double a : list_cuts(bvh, bvh.nodes[node].first, left, node_cost))
            for (const double b : list_cuts(bvh, bvh.nodes[node].first + 1, slots - left, node_cost))
                cuts.push_back(a + b);
    return cuts;
}

struct Walk {
    double area = 0;
    size_t nodes = 0, leaves = 0;
};

void walk(const Bvh& bvh, const WideCollapse& collapse, uint32_t root, Walk& sum) {
    const WideChildren children = collapse.collect_children(root);
    ASSERT_GE(children.count, 1);
    ASSERT_LE(children.count, kMaxWideChildCount);
    ++sum.nodes, sum.area += find_area(bvh, root);
    for (int k = 0; k < children.count; ++k) {
        const uint32_t child = children.nodes[size_t(k)];
        if (bvh.nodes[child].is_leaf())
            ++sum.leaves;
        else
            walk(bvh, collapse, child, sum);
    }
}

TEST(WideCollapse, has_the_least_area_of_all_ways_to_cut_small_trees) {
    for (const test::BoxSet& set : test::make_box_sets()) {
        const size_t count = std::min<size_t>(set.boxes.size(), 11);
        SahBvhBuilder::Config config;
        config.max_leaf_size = 1;
        const Bvh bvh = SahBvhBuilder::build(std::span(set.boxes).first(count), config);
        if (bvh.nodes[0].is_leaf()) continue;
        const WideCollapse collapse(bvh);
        Walk sum;
        walk(bvh, collapse, 0, sum);
        EXPECT_EQ(sum.leaves, count) << set.name;
        EXPECT_EQ(collapse.leaf_count(), count) << set.name;
        const double node_cost = collapse.node_cost();
        const double least = find_least(bvh, 0, node_cost);
        EXPECT_NEAR(sum.area + double(sum.nodes) * node_cost, least, 1e-5 * least) << set.name;
    }
}

TEST(WideCollapse, fills_its_nodes) {
    for (const test::BoxSet& set : test::make_box_sets()) {
        if (set.boxes.size() < 200) continue;
        SahBvhBuilder::Config config;
        config.max_leaf_size = 1;
        const Bvh bvh = SahBvhBuilder::build(set.boxes, config);
        Walk sum;
        walk(bvh, WideCollapse(bvh), 0, sum);
        EXPECT_EQ(sum.leaves, set.boxes.size()) << set.name;
        EXPECT_LE(double(sum.nodes), 0.3 * double(set.boxes.size())) << set.name;
    }
}

} // namespace
} // namespace relief
