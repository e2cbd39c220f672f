#include "bvh/wide_bvh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "bvh/sah_bvh.h"
#include "support/box_sets.h"

namespace relief {
namespace {

using test::BoxSet;

WideBvh build_wide(const std::vector<Box>& boxes, uint32_t max_leaf_size) {
    SahBvhBuilder::Config config;
    config.max_leaf_size = max_leaf_size;
    return make_wide_bvh(SahBvhBuilder::build(boxes, config));
}

/// Union of the boxes below a child; marks its primitives. Checks on the way that decoded boxes hold what is
/// below.
Box visit(const WideBvh& bvh, uint32_t child, const std::vector<Box>& boxes, std::vector<int>& seen,
          size_t& nodes) {
    Box all;
    if (WideNode::is_leaf(child)) {
        for (uint32_t k = 0; k < WideNode::leaf_count(child); ++k) {
            const uint32_t id = bvh.primitive_at(WideNode::leaf_first(child) + k);
            EXPECT_LT(id, boxes.size());
            ++seen.at(id);
            all.extend(boxes.at(id));
        }
        return all;
    }
    ++nodes;
    const WideNode& node = bvh.nodes.at(child);
    EXPECT_GE(node.child_count, 1);
    for (int k = 0; k < 8; ++k) {
        if (k >= node.child_count) {
            EXPECT_EQ(node.child[k], WideNode::kNoChild);
            const Box unused = node.child_box(k);
            EXPECT_GT(unused.lower.x, unused.upper.x);
            continue;
        }
        const Box below = visit(bvh, node.child[k], boxes, seen, nodes);
        EXPECT_TRUE(node.child_box(k).contains(below));
        all.extend(below);
    }
    return all;
}

TEST(WideBvh, holds_every_primitive_once_inside_all_decoded_boxes_above_it) {
    for (const BoxSet& set : test::make_box_sets())
        for (const uint32_t leaf_size : {1u, 4u, 8u}) {
            SCOPED_TRACE(set.name);
            const WideBvh bvh = build_wide(set.boxes, leaf_size);
            std::vector<int> seen(set.boxes.size());
            size_t nodes = 0;
            const Box all = visit(bvh, 0, set.boxes, seen, nodes);
            EXPECT_EQ(nodes, bvh.nodes.size());
            for (const int times : seen) ASSERT_EQ(times, 1);
            EXPECT_EQ(bvh.bounds.lower, all.lower);
            EXPECT_EQ(bvh.bounds.upper, all.upper);
        }
}

TEST(WideBvh, widens_a_child_by_at_most_two_steps_of_its_parent) {
    // Eight boxes of one parent, away from zero only as far as float rounding stays below a step.
    for (const float size : {1e-30f, 1.0f, 1e30f}) {
        const std::vector<Box> boxes = test::make_random_boxes(70, 8, size, size / 4);
        const WideBvh bvh = build_wide(boxes, 1);
        ASSERT_EQ(bvh.nodes.size(), 1u);
        const WideNode& node = bvh.nodes[0];
        for (int axis = 0; axis < 3; ++axis) {
            const float step = WideNode::decode_scale(node.exponent[axis]);
            EXPECT_LE(step * 255, 2.001f * get_component(bvh.bounds.extent(), axis));
            for (int k = 0; k < node.child_count; ++k) {
                const Box decoded = node.child_box(k), exact = boxes[WideNode::leaf_first(node.child[k])];
                EXPECT_GE(get_component(decoded.lower, axis),
                          get_component(exact.lower, axis) - 1.01f * step);
                EXPECT_LE(get_component(decoded.upper, axis),
                          get_component(exact.upper, axis) + 1.01f * step);
            }
        }
    }
}

TEST(WideBvh, keeps_flat_boxes_flat) {
    std::vector<Box> boxes = test::make_random_boxes(71, 200, 1, 0.1f, {1, 0, 1});
    for (Box& box : boxes) box.lower.y = box.upper.y = 12345.678f;
    const WideBvh bvh = build_wide(boxes, 1);
    for (const WideNode& node : bvh.nodes)
        for (int k = 0; k < node.child_count; ++k) {
            EXPECT_EQ(node.child_box(k).lower.y, 12345.678f);
            EXPECT_EQ(node.child_box(k).upper.y, 12345.678f);
        }
}

TEST(WideBvh, decodes_boxes_around_extents_of_one_rounding_step) {
    for (const float origin : {1.0f, -1.0f, 3e7f, -1e30f, 1e-37f, 0.0f}) {
        std::vector<Box> boxes;
        float upper = origin;
        for (int k = 0; k < 6; ++k) {
            boxes.push_back({{origin, origin, 0}, {upper, origin, 1}});
            upper = std::nextafter(upper, std::numeric_limits<float>::infinity());
        }
        const WideBvh bvh = build_wide(boxes, 1);
        std::vector<int> seen(boxes.size());
        size_t nodes = 0;
        visit(bvh, 0, boxes, seen, nodes);
    }
}

TEST(WideBvh, needs_no_id_list_when_every_leaf_holds_one_primitive) {
    const std::vector<Box> boxes = test::make_random_boxes(72, 1000, 1, 0.1f);
    EXPECT_TRUE(build_wide(boxes, 1).primitive_ids.empty());
    EXPECT_EQ(build_wide(std::vector<Box>(100, boxes[0]), 4).primitive_ids.size(), 100u);
}

TEST(WideBvh, fills_its_nodes) {
    const std::vector<Box> boxes = test::make_random_boxes(73, 20000, 10, 0.1f);
    const WideBvh bvh = build_wide(boxes, 1);
    size_t children = 0;
    for (const WideNode& node : bvh.nodes) children += node.child_count;
    EXPECT_GT(double(children) / double(bvh.nodes.size()), 5.0);
    EXPECT_EQ(bvh.byte_count(), bvh.nodes.size() * 96);
}

TEST(WideBvh, holds_moved_boxes_after_a_refit_and_does_not_grow) {
    std::vector<Box> boxes = test::make_random_boxes(74, 3000, 10, 0.2f);
    WideBvh bvh = build_wide(boxes, 1);
    std::mt19937 random(5);
    const std::vector<Box> home = boxes;
    Box first_bounds;
    for (int round = 0; round < 40; ++round) {
        // Away in even rounds and home again in odd ones.
        std::vector<uint8_t> is_moved(boxes.size());
        for (size_t k = 0; k < boxes.size(); ++k) {
            if (k % 97 != 5) continue;
            is_moved[k] = 1;
            const Vec3f by = round % 2 == 0 ? test::make_point(random, 4) : Vec3f{};
            boxes[k] = {home[k].lower + by, home[k].upper + by};
        }
        refit_wide_bvh(bvh, is_moved, [&](uint32_t k) { return boxes[k]; });
        std::vector<int> seen(boxes.size());
        size_t nodes = 0;
        const Box all = visit(bvh, 0, boxes, seen, nodes);
        EXPECT_TRUE(bvh.bounds.contains(all));
        if (round == 1) first_bounds = bvh.bounds;
        if (round % 2 == 1) {
            EXPECT_EQ(bvh.bounds.lower, first_bounds.lower);
            EXPECT_EQ(bvh.bounds.upper, first_bounds.upper);
        }
    }
}

TEST(WideBvh, refit_touches_nothing_where_nothing_moved) {
    const std::vector<Box> boxes = test::make_random_boxes(75, 500, 10, 0.2f);
    WideBvh bvh = build_wide(boxes, 1);
    const WideBvh before = bvh;
    refit_wide_bvh(bvh, std::vector<uint8_t>(boxes.size()), [](uint32_t) -> Box { throw 1; });
    EXPECT_EQ(std::memcmp(bvh.nodes.data(), before.nodes.data(), bvh.byte_count()), 0);
}

TEST(WideBvh, is_empty_without_primitives) {
    const WideBvh bvh = make_wide_bvh({});
    EXPECT_TRUE(bvh.nodes.empty());
    EXPECT_TRUE(bvh.bounds.is_empty());
    EXPECT_EQ(bvh.byte_count(), 0u);
}

TEST(WideBvh, packs_leaves_into_a_word) {
    const uint32_t word = WideNode::make_leaf(0x0fffffffu, 7);
    EXPECT_TRUE(WideNode::is_leaf(word));
    EXPECT_EQ(WideNode::leaf_first(word), 0x0fffffffu);
    EXPECT_EQ(WideNode::leaf_count(word), 7u);
    EXPECT_FALSE(WideNode::is_leaf(5));
    EXPECT_NE(word, WideNode::kNoChild);
}

} // namespace
} // namespace relief
