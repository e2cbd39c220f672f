// Every walk over a binary tree visits the leaves that recursion visits, in the same order.
#include <gtest/gtest.h>

#include <algorithm>

#include "lab/walks/trail.h"
#include "support/dense_heap.h"
#include "support/synthetic_trees.h"
#include "support/walks_from_root.h"

namespace relief {
namespace {

using test::Order;
using test::RecursiveWalk;
using test::Shape;

/// One ray through one tree; `limits` as for RecursiveWalk.
class OrderCase {
  public:
    OrderCase(const Bvh& bvh, const std::vector<uint8_t>& axes, const BoxRay& ray,
              const std::vector<float>& limits)
        : linked_(make_linked_bvh({bvh, axes, compute_depth(bvh)})),
          succinct_(make_succinct_heap({bvh, axes, compute_depth(bvh)})),
          ray_(ray),
          limits_(limits) {
        if (linked_.depth < 12) dense_ = test::make_dense_heap(bvh, axes);
    }

    void expect_same_order() {
        expect<TraversalKind::stack>(make_walk_view(linked_), Order::distance);
        expect<TraversalKind::parent_link>(make_walk_view(linked_), Order::axis);
        expect<TraversalKind::skip_link>(make_walk_view(linked_), Order::left);
        expect<TraversalKind::restart_trail>(make_wide_walk_view(linked_), Order::distance);
        expect<TraversalKind::trail>(make_wide_walk_view(succinct_), Order::axis);
        expect<TraversalKind::pair_trail>(make_wide_walk_view(succinct_), Order::distance);
        if (linked_.depth <= int(scalar::kTrailLevels32)) {
            expect<TraversalKind::restart_trail>(make_walk_view(linked_), Order::distance);
            expect<TraversalKind::trail>(make_walk_view(succinct_), Order::axis);
            expect<TraversalKind::pair_trail>(make_walk_view(succinct_), Order::distance);
        }
        if (!dense_.nodes.empty()) {
            expect<TraversalKind::trail>(make_walk_view(dense_), Order::axis);
            expect<TraversalKind::pair_trail>(make_walk_view(dense_), Order::distance);
        }
    }

    size_t visited() const { return visited_; }
    uint64_t restarts() const { return restarts_; }

  private:
    template <TraversalKind kTraversal, class View> void expect(const View& view, Order order) {
        const std::vector<uint32_t> expected = RecursiveWalk(linked_, ray_, limits_, order).run();
        std::vector<uint32_t> leaves;
        BoxRay ray = ray_;
        WalkCounts counts;
        closest_hit<kTraversal>(
            view, ray,
            [&](uint32_t id, BoxRay& r) {
                leaves.push_back(id);
                r.t_max = std::min(r.t_max, limits_[id]);
            },
            counts);
        ASSERT_EQ(leaves, expected) << "traversal " << int(kTraversal);
        ASSERT_EQ(counts.primitive_tests, leaves.size());
        visited_ += leaves.size();
        restarts_ += counts.restarts;
        expect_end_at_a_leaf<kTraversal>(view, expected);
    }

    /// A walk that is to end at a leaf ends there.
    template <TraversalKind kTraversal, class View>
    void expect_end_at_a_leaf(const View& view, const std::vector<uint32_t>& expected) {
        if (expected.empty()) return;
        const uint32_t last = expected[expected.size() / 2];
        std::vector<uint32_t> leaves;
        BoxRay ray = ray_;
        const auto leaf = [&](uint32_t id, BoxRay& r) {
            leaves.push_back(id);
            r.t_max = std::min(r.t_max, limits_[id]);
            return id == last;
        };
        ASSERT_TRUE(any_hit<kTraversal>(view, ray, leaf));
        ASSERT_EQ(leaves.size(), expected.size() / 2 + 1);
    }

    LinkedBvh linked_;
    SuccinctHeap succinct_;
    DenseHeap dense_;
    BoxRay ray_;
    const std::vector<float>& limits_;
    size_t visited_ = 0;
    uint64_t restarts_ = 0;
};

struct Totals {
    size_t visited = 0;
    uint64_t restarts = 0;
    int beyond_narrow = 0; ///< trees that words of 32 bits are too short for
    int at_last_level = 0; ///< trees of as many levels as words of 64 bits have room for
};

/// Random boxes, axes and directions; half of the rays are shortened on the way.
void check_shape(const Shape& shape, std::mt19937& random, int repeats, Totals& totals) {
    for (int k = 0; k < repeats; ++k) {
        const test::SyntheticRay ray = test::make_synthetic_ray(random());
        const double misses[] = {0, 0.1, 0.3, 0.6};
        const Bvh bvh = test::make_synthetic_bvh(shape, random, ray, misses[random() % 4]);
        std::vector<float> limits(bvh.primitive_ids.size(), 1e30f);
        const uint32_t reach = 2 + random() % 60;
        if (random() % 2)
            for (float& limit : limits) limit = random() % 4 ? 1e30f : 0.5f + float(random() % reach);
        OrderCase test(bvh, test::make_random_axes(bvh, random), ray.ray(), limits);
        test.expect_same_order();
        totals.visited += test.visited();
        totals.restarts += test.restarts();
        const int depth = compute_depth(bvh);
        totals.beyond_narrow += depth > int(scalar::kTrailLevels32);
        totals.at_last_level += depth == int(scalar::kTrailLevels64);
    }
}

TEST(LeafOrder, is_that_of_recursion_for_all_shapes_to_depth_four) {
    std::mt19937 random(1);
    Totals totals;
    const std::vector<Shape> shapes = test::make_all_shapes(4);
    EXPECT_EQ(shapes.size(), 677u);
    for (const Shape& shape : shapes) check_shape(shape, random, 30, totals);
    EXPECT_GT(totals.visited, 100000u);
}

TEST(LeafOrder, is_that_of_recursion_for_shapes_of_depth_five_and_six) {
    std::mt19937 random(2);
    Totals totals;
    for (int k = 0; k < 8000; ++k)
        for (const int depth : {5, 6}) {
            const double probability = 0.5 + 0.1 * (k % 6);
            check_shape(test::make_random_shape(random, depth, probability, 1000), random, 1, totals);
        }
    EXPECT_GT(totals.visited, 100000u);
    EXPECT_GT(totals.restarts, 1000u);
}

TEST(LeafOrder, is_that_of_recursion_for_deep_random_trees) {
    std::mt19937 random(3);
    Totals totals;
    for (int k = 0; k < 2000; ++k) {
        const int depth = 7 + k % 56;
        check_shape(test::make_random_shape(random, depth, 0.55 + 0.05 * (k % 5), 400), random, 1, totals);
    }
    EXPECT_GT(totals.restarts, 100u);
    EXPECT_GT(totals.beyond_narrow, 1000);
    EXPECT_GT(totals.at_last_level, 30);
}

TEST(LeafOrder, is_that_of_recursion_for_chains_down_to_the_last_level) {
    std::mt19937_64 sides(4);
    std::mt19937 random(5);
    Totals totals;
    for (const int depth : {1, 2, 29, 30, 31, 61, 62})
        for (int k = 0; k < 40; ++k) {
            const uint64_t pattern = k == 0 ? 0 : k == 1 ? ~uint64_t(0) : sides();
            check_shape(test::make_chain(depth, pattern), random, 4, totals);
        }
    EXPECT_GT(totals.restarts, 100u);
}

TEST(LeafOrder, of_a_chain_with_two_leaves_at_its_end_uses_every_bit) {
    // Both trails are all ones before they end.
    std::mt19937 random(6);
    for (const int depth : {30, 62})
        for (const uint32_t signs : {0u, 7u}) {
            const test::SyntheticRay ray = test::make_synthetic_ray(signs);
            const Bvh bvh =
                test::make_synthetic_bvh(test::make_chain(depth, signs ? 0 : ~uint64_t(0)), random, ray, 0);
            const std::vector<float> limits(bvh.primitive_ids.size(), 1e30f);
            OrderCase test(bvh, test::make_random_axes(bvh, random), ray.ray(), limits);
            test.expect_same_order();
        }
}

/// Keys of all leaves, with their primitives.
struct KeyedLeaf {
    uint64_t key;
    uint32_t id;
};

std::vector<KeyedLeaf> find_leaf_keys(const Bvh& bvh) {
    std::vector<KeyedLeaf> leaves, pending{{1, 0}};
    while (!pending.empty()) {
        const KeyedLeaf place = pending.back();
        pending.pop_back();
        const BvhNode& node = bvh.nodes[place.id];
        if (node.is_leaf()) {
            leaves.push_back({place.key, bvh.primitive_ids[node.first]});
            continue;
        }
        pending.push_back({2 * place.key, node.first});
        pending.push_back({2 * place.key + 1, node.first + 1});
    }
    return leaves;
}

template <TraversalKind kTraversal, class View>
void expect_all_from(const View& view, typename View::Key start, uint32_t first, size_t count,
                     const BoxRay& ray) {
    std::vector<uint32_t> leaves;
    const auto leaf = [&](uint32_t id, const BoxRay&) {
        leaves.push_back(id);
        return false;
    };
    EXPECT_FALSE(any_hit_from<kTraversal>(view, start, ray, leaf));
    ASSERT_EQ(leaves.size(), count);
    EXPECT_EQ(leaves[0], first);
    std::sort(leaves.begin(), leaves.end());
    for (size_t k = 0; k < count; ++k) EXPECT_EQ(leaves[k], k);
}

TEST(LeafOrder, from_any_leaf_has_every_leaf_once) {
    std::mt19937 random(7);
    for (int k = 0; k < 60; ++k) {
        const int depth = k % 3 == 0 ? 62 : 3 + k % 27;
        const Shape shape = k % 2 ? test::make_random_shape(random, depth, 0.75, 100)
                                  : test::make_chain(depth, random() * uint64_t(0x100000001));
        const test::SyntheticRay ray = test::make_synthetic_ray(random());
        const Bvh bvh = test::make_synthetic_bvh(shape, random, ray, 0);
        const std::vector<uint8_t> axes = test::make_random_axes(bvh, random);
        const SuccinctHeap heap = make_succinct_heap({bvh, axes, compute_depth(bvh)});
        for (const KeyedLeaf& leaf : find_leaf_keys(bvh)) {
            const size_t count = bvh.primitive_ids.size();
            const scalar::HeapKey key{uint32_t(leaf.key), uint32_t(leaf.key >> 32)};
            expect_all_from<TraversalKind::trail>(make_wide_walk_view(heap), key, leaf.id, count, ray.ray());
            expect_all_from<TraversalKind::pair_trail>(make_wide_walk_view(heap), key, leaf.id, count,
                                                       ray.ray());
            if (heap.depth > int(scalar::kTrailLevels32)) continue;
            expect_all_from<TraversalKind::trail>(make_walk_view(heap), key.low, leaf.id, count, ray.ray());
            expect_all_from<TraversalKind::pair_trail>(make_walk_view(heap), key.low, leaf.id, count,
                                                       ray.ray());
        }
    }
}

TEST(LeafOrder, remembers_the_leaf_that_stopped_a_ray) {
    std::mt19937 random(8);
    const test::SyntheticRay ray = test::make_synthetic_ray(0);
    const Bvh bvh = test::make_synthetic_bvh(test::make_random_shape(random, 9, 0.9, 200), random, ray, 0);
    const DenseHeap heap = test::make_dense_heap(bvh, test::make_random_axes(bvh, random));
    for (const KeyedLeaf& wanted : find_leaf_keys(bvh)) {
        const auto leaf = [&](uint32_t id, const BoxRay&) { return id == wanted.id; };
        uint32_t trail_start = 1, pair_start = 1;
        EXPECT_TRUE(any_hit_from<TraversalKind::trail>(make_walk_view(heap), trail_start, ray.ray(), leaf));
        EXPECT_TRUE(
            any_hit_from<TraversalKind::pair_trail>(make_walk_view(heap), pair_start, ray.ray(), leaf));
        EXPECT_EQ(trail_start, wanted.key);
        EXPECT_EQ(pair_start, wanted.key);
        // The next ray needs one box for the same answer.
        WalkCounts counts;
        EXPECT_TRUE(
            any_hit_from<TraversalKind::trail>(make_walk_view(heap), trail_start, ray.ray(), leaf, counts));
        EXPECT_EQ(counts.box_tests, 1u);
        EXPECT_EQ(counts.primitive_tests, 1u);
    }
}

} // namespace
} // namespace relief
