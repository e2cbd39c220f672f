#include "lab/trees/heap_tree.h"

#include <gtest/gtest.h>

#include <bit>

#include "bvh/sah_bvh.h"
#include "formulas/tree.h"
#include "lab/trees/lbvh.h"
#include "lab/walks/trail.h"
#include "lab/walks/walks.h"
#include "relief/error.h"
#include "support/box_sets.h"
#include "support/dense_heap.h"
#include "support/synthetic_trees.h"
#include "support/tree_checks.h"

namespace relief {
namespace {

using test::BoxSet;

/// The look-up of lab/walks/succinct_heap.h without a walk.
template <class Width> class SlotFinder {
  public:
    explicit SlotFinder(const SuccinctHeap& heap) : heap_(heap) {}
    uint32_t find(const Width& key) { return find_succinct_slot(key); }

  private:
    using Key = Width;
    using uint = uint32_t;
    using HeapForm = scalar::HeapForm;
    using HeapBlock = scalar::HeapBlock;
    using HeapBrick = scalar::HeapBrick;
    static constexpr uint kHeapBlockBytes = scalar::kHeapBlockBytes;
    static constexpr uint kHeapBrickBytes = scalar::kHeapBrickBytes;
    static constexpr uint kBrickLevels = scalar::kBrickLevels;
    static Key shift_right(const Key& key, uint count) { return scalar::shift_right(key, count); }
    static bool is_zero(const Key& key) { return scalar::is_zero(key); }
    static uint get_key_level(const Key& key) { return scalar::get_key_level(key); }
    static uint get_low_word(const Key& key) { return scalar::get_low_word(key); }
    static uint rank_bits(uint low, uint high, uint place) { return scalar::rank_bits(low, high, place); }
    HeapForm get_heap_form() const { return heap_.form; }
    HeapBlock load_heap_block(uint block) const { return heap_.blocks.at(block); }
    HeapBrick load_heap_brick(uint brick) const { return heap_.bricks.at(brick); }
    void count_bytes(uint) const {}

#include "lab/walks/succinct_heap.h"

    const SuccinctHeap& heap_;
};

struct KeyedNode {
    uint64_t key;
    uint32_t node;
};

std::vector<KeyedNode> find_keys(const Bvh& bvh) {
    std::vector<KeyedNode> keys{{1, 0}};
    for (size_t k = 0; k < keys.size(); ++k) {
        const KeyedNode place = keys[k];
        if (bvh.nodes[place.node].is_leaf()) continue;
        keys.push_back({2 * place.key, bvh.nodes[place.node].first});
        keys.push_back({2 * place.key + 1, bvh.nodes[place.node].first + 1});
    }
    return keys;
}

void expect_same_node(const TreeNode& node, const Bvh& bvh, const std::vector<uint8_t>& axes,
                      uint32_t index) {
    const BvhNode& other = bvh.nodes[index];
    ASSERT_EQ(node.lower, other.lower);
    ASSERT_EQ(node.upper, other.upper);
    if (other.is_leaf()) {
        ASSERT_EQ(node.first, other.first);
        ASSERT_EQ(node.word, other.primitive_count);
    } else {
        ASSERT_FALSE(scalar::is_leaf_word(node.word));
        ASSERT_EQ(scalar::get_word_axis(node.word), axes[index]);
    }
}

/// Every key leads to its node; siblings are neighbours on a line of 64 bytes; no slot is without a node.
void expect_complete(const Bvh& bvh, const std::vector<uint8_t>& axes) {
    const SuccinctHeap heap = make_succinct_heap({bvh, axes, compute_depth(bvh)});
    SlotFinder<scalar::HeapKey> wide(heap);
    SlotFinder<uint32_t> narrow(heap);
    std::vector<int> used(heap.nodes.size());
    for (const KeyedNode& place : find_keys(bvh)) {
        const uint32_t slot = wide.find({uint32_t(place.key), uint32_t(place.key >> 32)});
        ASSERT_LT(slot, heap.nodes.size());
        if (heap.depth <= int(scalar::kTrailLevels32)) {
            ASSERT_EQ(narrow.find(uint32_t(place.key)), slot);
        }
        ASSERT_EQ(slot & 1u, place.key & 1u);
        ++used[slot];
        expect_same_node(heap.nodes[slot], bvh, axes, place.node);
        ASSERT_TRUE(contains_key(heap, place.key));
        if (!bvh.nodes[place.node].is_leaf()) continue;
        for (int below = 1; below < std::countl_zero(place.key); ++below)
            ASSERT_FALSE(contains_key(heap, (place.key << below) + uint64_t(below)));
    }
    EXPECT_FALSE(contains_key(heap, 0));
    EXPECT_EQ(heap.nodes.size(), bvh.nodes.size() + 1);
    for (size_t k = 1; k < used.size(); ++k) ASSERT_EQ(used[k], 1);
    EXPECT_EQ(heap.primitive_ids, bvh.primitive_ids);
}

TEST(SuccinctHeap, leads_from_every_key_to_its_node) {
    for (const BoxSet& set : test::make_box_sets()) {
        SCOPED_TRACE(set.name);
        SahBvhBuilder::Config config;
        config.max_depth = int(scalar::kTrailLevels64);
        const Bvh bvh = SahBvhBuilder::build(set.boxes, config);
        expect_complete(bvh, compute_axes(bvh));
        const AxisBvh linear = LbvhBuilder::build(set.boxes, {63, 1});
        EXPECT_EQ(linear.depth, compute_depth(linear.bvh));
        const Bvh limited = limit_depth(linear.bvh, 62);
        expect_complete(limited, compute_axes(limited));
    }
}

TEST(SuccinctHeap, leads_through_chains_and_random_trees_of_any_depth) {
    std::mt19937_64 random(80);
    std::mt19937 shapes(81);
    const test::SyntheticRay ray = test::make_synthetic_ray(0);
    for (int k = 0; k < 300; ++k) {
        const int depth = k % 63;
        const test::Shape shape = k % 2 ? test::make_chain(depth, random())
                                        : test::make_random_shape(shapes, depth, 0.6 + 0.1 * (k % 4), 3000);
        const Bvh bvh = test::make_synthetic_bvh(shape, shapes, ray, 0);
        expect_complete(bvh, test::make_random_axes(bvh, shapes));
    }
}

TEST(SuccinctHeap, spends_two_bytes_on_the_way_to_a_pair) {
    const std::vector<Box> boxes = test::make_random_boxes(82, 50000, 10, 0.05f);
    for (const bool is_linear : {false, true}) {
        const Bvh bvh = is_linear ? LbvhBuilder::build(boxes, {30, 1}).bvh : SahBvhBuilder::build(boxes, {});
        const SuccinctHeap heap = make_succinct_heap(add_axes(bvh));
        EXPECT_LT(double(heap.directory_bytes()), 2.0 * double(bvh.nodes.size() / 2) + 64);
        EXPECT_EQ(heap.byte_count(),
                  heap.directory_bytes() + heap.nodes.size() * 32 + heap.primitive_ids.size() * 4);
    }
}

TEST(SuccinctHeap, refuses_trees_that_are_deeper_than_its_keys) {
    std::mt19937 random(83);
    const test::SyntheticRay ray = test::make_synthetic_ray(0);
    const Bvh bvh = test::make_synthetic_bvh(test::make_chain(63, 0), random, ray, 0);
    const std::vector<uint8_t> axes = compute_axes(bvh);
    EXPECT_THROW(make_succinct_heap({bvh, axes, compute_depth(bvh)}), Error);
    const Bvh limited = limit_depth(bvh, 62);
    EXPECT_NO_THROW(make_succinct_heap(add_axes(limited)));
}

TEST(DenseHeap, has_each_node_in_the_slot_of_its_key) {
    for (const BoxSet& set : test::make_box_sets()) {
        SCOPED_TRACE(set.name);
        SahBvhBuilder::Config config;
        config.max_depth = 16;
        const Bvh bvh = SahBvhBuilder::build(set.boxes, config);
        const std::vector<uint8_t> axes = compute_axes(bvh);
        const DenseHeap heap = test::make_dense_heap(bvh, axes);
        EXPECT_EQ(count_used_slots(heap), bvh.nodes.size());
        EXPECT_EQ(heap.nodes[0].word, scalar::kEmptySlot);
        for (const KeyedNode& place : find_keys(bvh))
            expect_same_node(heap.nodes[place.key], bvh, axes, place.node);
    }
}

TEST(Heaps, are_empty_without_primitives) {
    EXPECT_TRUE(make_succinct_heap({}).nodes.empty());
    EXPECT_TRUE(make_linked_bvh({}).nodes.empty());
    EXPECT_EQ(compute_depth(Bvh{}), 0);
    EXPECT_EQ(compute_depth(DenseHeap{}), 0);
}

TEST(LinkedBvh, has_parents_and_skips_of_the_depth_first_order) {
    for (const BoxSet& set : test::make_box_sets()) {
        SCOPED_TRACE(set.name);
        const Bvh bvh = SahBvhBuilder::build(set.boxes, {});
        const LinkedBvh linked = make_linked_bvh(add_axes(bvh));
        EXPECT_EQ(linked.depth, compute_depth(bvh));
        EXPECT_EQ(linked.parents[0], scalar::kNoNode);
        std::vector<uint32_t> order, pending{0};
        std::vector<size_t> subtree_end(bvh.nodes.size());
        const auto visit = [&](const auto& self, uint32_t node) -> void {
            order.push_back(node);
            if (!bvh.nodes[node].is_leaf())
                for (const uint32_t child : {bvh.nodes[node].first, bvh.nodes[node].first + 1}) {
                    EXPECT_EQ(linked.parents[child], node);
                    self(self, child);
                }
            subtree_end[node] = order.size();
        };
        visit(visit, 0);
        for (uint32_t node = 0; node < bvh.nodes.size(); ++node) {
            const size_t end = subtree_end[node];
            ASSERT_EQ(linked.skips[node], end < order.size() ? order[end] : scalar::kNoNode);
        }
    }
}

TEST(LinkedBvh, axes_have_the_left_child_lower) {
    const std::vector<Box> boxes = test::make_random_boxes(84, 3000, 10, 0.01f);
    const Bvh bvh = SahBvhBuilder::build(boxes, {});
    const std::vector<uint8_t> axes = compute_axes(bvh);
    for (size_t k = 0; k < bvh.nodes.size(); ++k) {
        if (bvh.nodes[k].is_leaf()) continue;
        const BvhNode &left = bvh.nodes[bvh.nodes[k].first], &right = bvh.nodes[bvh.nodes[k].first + 1];
        EXPECT_LT(get_component(left.box().center(), axes[k]), get_component(right.box().center(), axes[k]));
    }
}

TEST(LimitedDepth, keeps_every_primitive) {
    for (const BoxSet& set : test::make_box_sets())
        for (const int max_depth : {0, 1, 5, 30}) {
            SCOPED_TRACE(set.name);
            const Bvh limited = limit_depth(LbvhBuilder::build(set.boxes, {63, 1}).bvh, max_depth);
            test::expect_sound(limited, set.boxes, scalar::kNodeCountMask, max_depth);
        }
}

} // namespace
} // namespace relief
