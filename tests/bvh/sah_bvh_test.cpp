#include "bvh/sah_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "bvh/sah_split.h"
#include "bvh/tree_links.h"
#include "support/box_sets.h"
#include "support/tree_checks.h"

namespace relief {
namespace {

using test::BoxSet;
using test::expect_sound;
using test::is_same;
using Method = SahBvhBuilder::Method;

std::vector<SahBvhBuilder::Config> make_configs() {
    std::vector<SahBvhBuilder::Config> configs;
    for (const Method method : {Method::binned, Method::sweep})
        for (const uint32_t leaf_size : {1u, 4u, 8u}) {
            SahBvhBuilder::Config config;
            config.method = method;
            config.max_leaf_size = leaf_size;
            configs.push_back(config);
        }
    return configs;
}

double compute_cost(const Bvh& bvh, const SahBvhBuilder::Config& config) {
    double cost = 0;
    for (const BvhNode& node : bvh.nodes)
        cost += compute_half_area(node.box()) *
                (node.is_leaf() ? config.intersection_cost * node.primitive_count : config.traversal_cost);
    return cost / compute_half_area(bvh.nodes[0].box());
}

TEST(SahBvh, holds_every_primitive_once_and_children_inside_parents) {
    for (const BoxSet& set : test::make_box_sets())
        for (const SahBvhBuilder::Config& config : make_configs()) {
            SCOPED_TRACE(set.name);
            expect_sound(SahBvhBuilder::build(set.boxes, config), set.boxes, config.max_leaf_size);
        }
}

TEST(SahBvh, has_the_union_of_all_boxes_at_the_root) {
    for (const BoxSet& set : test::make_box_sets()) {
        const Bvh bvh = SahBvhBuilder::build(set.boxes, {});
        const Box all = test::compute_union(set.boxes);
        EXPECT_EQ(bvh.nodes[0].lower, all.lower) << set.name;
        EXPECT_EQ(bvh.nodes[0].upper, all.upper) << set.name;
    }
}

TEST(SahBvh, is_empty_without_primitives) {
    for (const SahBvhBuilder::Config& config : make_configs()) {
        const Bvh bvh = SahBvhBuilder::build({}, config);
        EXPECT_TRUE(bvh.nodes.empty());
        EXPECT_TRUE(bvh.primitive_ids.empty());
    }
}

TEST(SahBvh, is_one_leaf_for_one_primitive) {
    const Bvh bvh = SahBvhBuilder::build(std::vector<Box>{Box{{0, 0, 0}, {1, 1, 1}}}, {});
    ASSERT_EQ(bvh.nodes.size(), 1u);
    EXPECT_EQ(bvh.nodes[0].primitive_count, 1u);
}

TEST(SahBvh, is_the_same_for_any_number_of_threads) {
    const std::vector<Box> boxes = test::make_random_boxes(20, 30000, 10, 0.1f);
    for (const SahBvhBuilder::Config& config : make_configs()) {
        Bvh serial, parallel;
        with_threads(1, [&] { serial = SahBvhBuilder::build(boxes, config); });
        with_threads(4, [&] { parallel = SahBvhBuilder::build(boxes, config); });
        EXPECT_TRUE(is_same(serial, parallel));
    }
}

TEST(SahBvh, costs_no_more_when_swept_than_when_binned) {
    for (const uint32_t seed : {30u, 31u, 32u}) {
        const std::vector<Box> boxes = test::make_random_boxes(seed, 4000, 10, seed == 31 ? 5.0f : 0.2f);
        SahBvhBuilder::Config config;
        const double binned = compute_cost(SahBvhBuilder::build(boxes, config), config);
        config.method = Method::sweep;
        const double swept = compute_cost(SahBvhBuilder::build(boxes, config), config);
        EXPECT_LE(swept, binned * 1.05);
    }
}

TEST(SahBvh, costs_a_hundredth_of_testing_every_primitive) {
    std::vector<Box> boxes = test::make_random_boxes(40, 3000, 0.1f, 0.01f);
    for (const Box& box : test::make_random_boxes(41, 1000, 100, 0.01f)) boxes.push_back(box);
    SahBvhBuilder::Config config;
    const Bvh bvh = SahBvhBuilder::build(boxes, config);
    const double leaf_everything = double(boxes.size());
    EXPECT_LT(compute_cost(bvh, config), 0.01 * leaf_everything);
}

TEST(SahBvh, keeps_primitives_together_when_nodes_are_dear) {
    const std::vector<Box> boxes = test::make_random_boxes(50, 8, 1, 1);
    SahBvhBuilder::Config config;
    config.max_leaf_size = 8;
    config.traversal_cost = 100;
    EXPECT_EQ(SahBvhBuilder::build(boxes, config).nodes.size(), 1u);
    config.traversal_cost = 0.01f;
    EXPECT_GT(SahBvhBuilder::build(boxes, config).nodes.size(), 1u);
}

TEST(SahBvh, keeps_to_the_greatest_depth) {
    for (const BoxSet& set : test::make_box_sets())
        for (SahBvhBuilder::Config config : make_configs())
            for (const int max_depth : {11, 30, 62}) {
                SCOPED_TRACE(set.name);
                config.max_depth = max_depth;
                const Bvh bvh = SahBvhBuilder::build(set.boxes, config);
                // 2^11 leaves of two are enough for every set.
                const uint32_t leaf_size =
                    max_depth == 11 ? std::max(2u, config.max_leaf_size) : config.max_leaf_size;
                expect_sound(bvh, set.boxes, leaf_size, max_depth);
            }
}

TEST(SahBvh, puts_everything_into_leaves_of_the_last_level) {
    SahBvhBuilder::Config config;
    config.max_depth = 1;
    const std::vector<Box> boxes = test::make_random_boxes(42, 100, 1, 0.1f);
    const Bvh bvh = SahBvhBuilder::build(boxes, config);
    EXPECT_EQ(bvh.nodes.size(), 3u);
    expect_sound(bvh, boxes, 100, 1);
}

TEST(SahBvh, grows_wider_leaves_and_shallower_trees_at_the_costs_of_mobile_devices) {
    for (const uint32_t seed : {43u, 44u}) {
        const std::vector<Box> boxes = test::make_random_boxes(seed, 3000, 10, 0.3f);
        SahBvhBuilder::Config usual;
        usual.method = Method::sweep;
        usual.max_leaf_size = 8;
        SahBvhBuilder::Config mobile = usual;
        mobile.traversal_cost = 3.0f, mobile.intersection_cost = 1.5f;
        const Bvh a = SahBvhBuilder::build(boxes, usual), b = SahBvhBuilder::build(boxes, mobile);
        expect_sound(b, boxes, 8);
        EXPECT_LT(b.nodes.size(), a.nodes.size());
        EXPECT_LE(compute_depth(b), compute_depth(a));
        // By its own costs each tree is the better one.
        EXPECT_LT(compute_cost(a, usual), compute_cost(b, usual));
        EXPECT_LT(compute_cost(b, mobile), compute_cost(a, mobile));
    }
}

TEST(SahBvh, separates_two_distant_groups_at_the_root) {
    std::vector<Box> boxes = test::make_random_boxes(60, 50, 1, 0.1f);
    for (const Box& box : test::make_random_boxes(61, 450, 1, 0.1f))
        boxes.push_back({box.lower + Vec3f{100, 0, 0}, box.upper + Vec3f{100, 0, 0}});
    for (const SahBvhBuilder::Config& config : make_configs()) {
        const Bvh bvh = SahBvhBuilder::build(boxes, config);
        const BvhNode& left = bvh.nodes[bvh.nodes[0].first];
        EXPECT_LT(left.upper.x, 50);
        EXPECT_GT(bvh.nodes[bvh.nodes[0].first + 1].lower.x, 50);
    }
}

TEST(SahSplit, binning_stays_inside_the_bins_whatever_the_centroids_are) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<Box> boxes;
    for (const float x : {-kInfinity, -3e38f, -1.0f, 0.0f, 1.0f, 3e38f, kInfinity})
        boxes.push_back({{x, 0, 0}, {x, 1, 1}});
    boxes.push_back({{-kInfinity, 0, 0}, {kInfinity, 1, 1}}); // its centroid is NaN
    std::vector<NumberedBox> members;
    for (const Box& box : boxes) members.push_back(make_numbered_box(box, uint32_t(members.size())));
    const SplitInput input{members, {{-1, 0, 0, 0}, {1, 1, 1, 0}}};
    constexpr int kBins = 16;
    SahSplit split;
    split.axis = 0;
    for (const uint32_t cut : {1u, 8u, 15u}) {
        split.cut = cut;
        const uint32_t left = apply_binned_split(input, split, kBins).left_count;
        std::vector<uint32_t> front;
        for (uint32_t k = 0; k < left; ++k) front.push_back(members[k].id);
        for (const uint32_t low : {0u, 1u, 2u, 7u}) EXPECT_EQ(std::count(front.begin(), front.end(), low), 1);
        for (const uint32_t high : {4u, 5u, 6u}) EXPECT_EQ(std::count(front.begin(), front.end(), high), 0);
    }
    find_binned_split(input, kBins);
}

} // namespace
} // namespace relief
