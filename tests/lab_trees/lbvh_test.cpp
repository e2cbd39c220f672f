#include "lab/trees/lbvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/parallel.h"
#include "formulas/morton.h"
#include "formulas/tree.h"
#include "lab/trees/morton_order.h"
#include "support/box_sets.h"
#include "support/tree_checks.h"

namespace relief {
namespace {

using test::BoxSet;

/// The shared sets, and some whose codes repeat.
std::vector<BoxSet> make_sets() {
    std::vector<BoxSet> sets = test::make_box_sets();
    BoxSet clusters{"clusters of equal codes", {}};
    for (int cluster = 0; cluster < 40; ++cluster)
        for (int k = 0; k < cluster; ++k) {
            const float x = float(cluster * 17 % 40), y = float(cluster * 29 % 40);
            clusters.boxes.push_back({{x, y, 0}, {x, y, 1}});
        }
    sets.push_back(clusters);
    BoxSet far{"many in one cell and one far away", test::make_random_boxes(70, 1000, 1e-3f, 1e-5f)};
    far.boxes.push_back({{1e6f, 1e6f, 1e6f}, {1e6f, 1e6f, 1e6f}});
    sets.push_back(far);
    return sets;
}

std::vector<LbvhBuilder::Config> make_lbvh_configs() {
    std::vector<LbvhBuilder::Config> configs;
    for (const int code_bits : {30, 63})
        for (const uint32_t leaf_size : {1u, 4u, scalar::kNodeCountMask}) {
            LbvhBuilder::Config config;
            config.code_bits = code_bits;
            config.max_leaf_size = leaf_size;
            configs.push_back(config);
        }
    return configs;
}

uint64_t compute_code(const Box& box, const Box& scene, int code_bits) {
    const Vec3f centre = scalar::centre_of_box(box.lower, box.upper);
    const scalar::MortonCode code = code_bits == 30 ? scalar::make_morton30(centre, scene.lower, scene.upper)
                                                    : scalar::make_morton63(centre, scene.lower, scene.upper);
    return uint64_t(code.high) << 32 | code.low;
}

TEST(MortonOrder, is_that_of_a_stable_sort) {
    std::vector<BoxSet> sets = make_sets();
    sets.push_back({"several blocks", test::make_random_boxes(71, 100000, 1, 0)});
    for (const BoxSet& set : sets)
        for (const int code_bits : {30, 63}) {
            const MortonOrder order = compute_morton_order(set.boxes, code_bits);
            const Box scene = test::compute_union(set.boxes);
            EXPECT_EQ(order.scene.lower, scene.lower);
            EXPECT_EQ(order.scene.upper, scene.upper);
            std::vector<uint64_t> codes;
            for (const Box& box : set.boxes) codes.push_back(compute_code(box, scene, code_bits));
            std::vector<uint32_t> ids(set.boxes.size());
            std::iota(ids.begin(), ids.end(), 0u);
            std::stable_sort(ids.begin(), ids.end(),
                             [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });
            EXPECT_EQ(order.ids, ids) << set.name;
            for (size_t k = 0; k < ids.size(); ++k) ASSERT_EQ(order.codes[k], codes[ids[k]]) << set.name;
        }
}

/// The rule of lbvh.h word by word: ranges first, then numbers.
class RuleCheck {
  public:
    RuleCheck(const AxisBvh& tree, const MortonOrder& order, uint32_t max_leaf_size)
        : tree_(tree), order_(order), max_leaf_size_(max_leaf_size) {}

    void run() {
        ASSERT_EQ(tree_.bvh.primitive_ids, order_.ids);
        visit(0, 0, uint32_t(order_.ids.size()) - 1);
        std::sort(cuts_.begin(), cuts_.end());
        for (size_t k = 0; k < cuts_.size(); ++k) {
            ASSERT_EQ(cuts_[k].first_child, 1 + 2 * k);
            ASSERT_TRUE(k == 0 || cuts_[k].entry > cuts_[k - 1].entry);
        }
        ASSERT_EQ(tree_.bvh.nodes.size(), 1 + 2 * cuts_.size());
    }

  private:
    struct CutRecord {
        uint32_t entry, first_child;
        auto operator<=>(const CutRecord&) const = default;
    };

    void visit(uint32_t index, uint32_t a, uint32_t b) {
        const BvhNode& node = tree_.bvh.nodes[index];
        const bool is_one_code = order_.codes[a] == order_.codes[b];
        if (is_one_code && b - a < max_leaf_size_) {
            ASSERT_EQ(node.first, a);
            ASSERT_EQ(node.primitive_count, b - a + 1);
            ASSERT_EQ(tree_.axes[index], 0);
            return;
        }
        const auto bits = [&](uint32_t g) { return is_one_code ? uint64_t(g) : order_.codes[g]; };
        int bit = 63;
        while (((bits(a) ^ bits(b)) >> bit & 1) == 0) --bit;
        uint32_t cut = a;
        while ((bits(cut) >> bit & 1) == 0) ++cut;
        ASSERT_FALSE(node.is_leaf());
        ASSERT_EQ(tree_.axes[index], is_one_code ? 0 : 2 - bit % 3);
        cuts_.push_back({cut, node.first});
        visit(node.first, a, cut - 1);
        visit(node.first + 1, cut, b);
    }

    const AxisBvh& tree_;
    const MortonOrder& order_;
    uint32_t max_leaf_size_;
    std::vector<CutRecord> cuts_;
};

TEST(Lbvh, follows_its_rule) {
    for (const BoxSet& set : make_sets())
        for (const LbvhBuilder::Config& config : make_lbvh_configs()) {
            SCOPED_TRACE(set.name);
            const AxisBvh tree = LbvhBuilder::build(set.boxes, config);
            RuleCheck(tree, compute_morton_order(set.boxes, config.code_bits), config.max_leaf_size).run();
        }
}

TEST(Lbvh, holds_every_primitive_once_and_children_inside_parents) {
    for (const BoxSet& set : make_sets())
        for (const LbvhBuilder::Config& config : make_lbvh_configs()) {
            SCOPED_TRACE(set.name);
            const AxisBvh tree = LbvhBuilder::build(set.boxes, config);
            test::expect_sound(tree.bvh, set.boxes, config.max_leaf_size);
            const Box all = test::compute_union(set.boxes);
            EXPECT_EQ(tree.bvh.nodes[0].lower, all.lower);
            EXPECT_EQ(tree.bvh.nodes[0].upper, all.upper);
        }
}

TEST(Lbvh, is_empty_without_primitives) {
    EXPECT_TRUE(LbvhBuilder::build({}, {}).bvh.nodes.empty());
    EXPECT_TRUE(LbvhBuilder::build_heap({}, {}).nodes.empty());
    EXPECT_TRUE(compute_morton_order({}, 30).ids.empty());
}

TEST(Lbvh, is_the_same_for_any_number_of_threads) {
    const std::vector<Box> boxes = test::make_random_boxes(72, 100000, 10, 0.1f);
    for (const LbvhBuilder::Config& config : make_lbvh_configs()) {
        AxisBvh serial, parallel;
        DenseHeap serial_heap, parallel_heap;
        with_threads(1, [&] { serial = LbvhBuilder::build(boxes, config); });
        with_threads(2, [&] { parallel = LbvhBuilder::build(boxes, config); });
        EXPECT_TRUE(test::is_same(serial.bvh, parallel.bvh));
        EXPECT_EQ(serial.axes, parallel.axes);
        with_threads(1, [&] { serial_heap = LbvhBuilder::build_heap(boxes, {config.code_bits, 18}); });
        with_threads(2, [&] { parallel_heap = LbvhBuilder::build_heap(boxes, {config.code_bits, 18}); });
        EXPECT_TRUE(test::is_same_bytes(serial_heap.nodes, parallel_heap.nodes));
        EXPECT_EQ(serial_heap.primitive_ids, parallel_heap.primitive_ids);
    }
}

TEST(Lbvh, of_finer_codes_costs_less_where_primitives_crowd) {
    std::vector<Box> boxes = test::make_random_boxes(73, 3000, 1e-4f, 1e-5f);
    boxes.push_back({{-1, -1, -1}, {1, 1, 1}});
    LbvhBuilder::Config coarse, fine;
    coarse.max_leaf_size = fine.max_leaf_size = scalar::kNodeCountMask;
    fine.code_bits = 63;
    EXPECT_LT(LbvhBuilder::build(boxes, coarse).bvh.nodes.size() * 20, boxes.size());
    EXPECT_GT(LbvhBuilder::build(boxes, fine).bvh.nodes.size(), boxes.size());
}

/// The heap of the paper against the compact tree of the same codes, cut off at the last level.
void expect_same_tree(const DenseHeap& heap, const AxisBvh& tree, uint32_t key, uint32_t index,
                      size_t& used) {
    ++used;
    const TreeNode& node = heap.nodes[key];
    const BvhNode& other = tree.bvh.nodes[index];
    ASSERT_EQ(node.lower, other.lower);
    ASSERT_EQ(node.upper, other.upper);
    const bool is_last_level = int(std::bit_width(key)) == heap.levels;
    ASSERT_EQ(scalar::is_leaf_word(node.word), other.is_leaf() || is_last_level);
    if (!scalar::is_leaf_word(node.word)) {
        ASSERT_EQ(scalar::get_word_axis(node.word), tree.axes[index]);
        expect_same_tree(heap, tree, 2 * key, other.first, used);
        expect_same_tree(heap, tree, 2 * key + 1, other.first + 1, used);
    } else if (other.is_leaf()) {
        ASSERT_EQ(node.first, other.first);
        ASSERT_EQ(scalar::get_word_count(node.word), other.primitive_count);
    }
}

TEST(Lbvh, in_the_heap_of_the_paper_is_the_compact_tree) {
    for (const BoxSet& set : make_sets())
        for (const int code_bits : {30, 63})
            for (const int levels : {1, 2, 9, 14}) {
                SCOPED_TRACE(set.name);
                LbvhBuilder::Config config;
                config.code_bits = code_bits;
                config.max_leaf_size = scalar::kNodeCountMask;
                const DenseHeap heap = LbvhBuilder::build_heap(set.boxes, {code_bits, levels});
                EXPECT_EQ(heap.nodes.size(), size_t(1) << levels);
                size_t used = 0;
                expect_same_tree(heap, LbvhBuilder::build(set.boxes, config), 1, 0, used);
                EXPECT_EQ(used, count_used_slots(heap));
                std::vector<int> seen(set.boxes.size());
                for (const TreeNode& node : heap.nodes) {
                    if (node.word == scalar::kEmptySlot || !scalar::is_leaf_word(node.word)) continue;
                    for (uint32_t k = 0; k < scalar::get_word_count(node.word); ++k)
                        ++seen[heap.primitive_ids[node.first + k]];
                }
                for (const int times : seen) ASSERT_EQ(times, 1);
            }
}

TEST(Lbvh, has_as_many_slots_as_the_examples_of_the_paper) {
    EXPECT_EQ(choose_heap_levels(279163), 21);
    EXPECT_EQ(choose_heap_levels(2097152), 23);
    EXPECT_EQ(choose_heap_levels(1), 2);
    EXPECT_EQ(choose_heap_levels(size_t(1) << 40), DenseHeap::kMaxLevels);
}

} // namespace
} // namespace relief
