#include "lab/trees/sah_kdtree.h"

#include <gtest/gtest.h>

#include <bit>

#include "base/parallel.h"
#include "formulas/tree.h"
#include "support/ray_cases.h"
#include "support/tree_checks.h"
#include "support/walks_from_root.h"

namespace relief {
namespace {

using test::AnyLeaf;
using test::BoxSet;
using test::Nearest;
using test::NearestLeaf;
using test::Triangle;
using Cells = SahKdTreeBuilder::Cells;

std::vector<SahKdTreeBuilder::Config> make_kdtree_configs() {
    std::vector<SahKdTreeBuilder::Config> configs;
    for (const float empty_factor : {1.0f, 0.8f})
        for (const float traversal_cost : {3.0f, 0.1f}) {
            SahKdTreeBuilder::Config config;
            config.empty_factor = empty_factor;
            config.traversal_cost = traversal_cost;
            config.cells = Cells::kept;
            configs.push_back(config);
        }
    return configs;
}

bool touches(const Box& a, const Box& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Cells tile their parents, have a thickness and are open where the root ends; the leaves hold what touches
/// them.
class SoundCheck {
  public:
    SoundCheck(const KdTree& tree, const std::vector<Box>& boxes) : tree_(tree), boxes_(boxes) {}

    void run() {
        ASSERT_EQ(tree_.cells.size(), tree_.nodes.size());
        visit(0, tree_.bounds, scalar::kNoNode, 0);
        EXPECT_EQ(visited_, tree_.nodes.size());
        EXPECT_EQ(entries_, tree_.primitive_ids.size());
        EXPECT_EQ(depth_, tree_.depth);
    }

  private:
    void visit(uint32_t index, const Box& cell, uint32_t parent, int depth) {
        ++visited_;
        depth_ = std::max(depth_, depth);
        ASSERT_LT(index, tree_.nodes.size());
        for (int axis = 0; axis < 3; ++axis) {
            const float lower = get_component(cell.lower, axis), upper = get_component(cell.upper, axis);
            const bool is_first = lower == get_component(tree_.bounds.lower, axis);
            const bool is_last = upper == get_component(tree_.bounds.upper, axis);
            ASSERT_EQ(get_component(tree_.cells[index].lower, axis), is_first ? -kInfinity : lower);
            ASSERT_EQ(get_component(tree_.cells[index].upper, axis), is_last ? kInfinity : upper);
        }
        ASSERT_EQ(tree_.cells[index].parent, parent);
        const scalar::KdNode& node = tree_.nodes[index];
        const uint32_t axis = node.word & 3u;
        if (axis == scalar::kKdLeaf) return check_leaf(node, cell);
        const float plane = std::bit_cast<float>(node.bits);
        ASSERT_GT(plane, get_component(cell.lower, int(axis)));
        ASSERT_LT(plane, get_component(cell.upper, int(axis)));
        Box left = cell, right = cell;
        set_component(left.upper, int(axis), plane);
        set_component(right.lower, int(axis), plane);
        visit(index + 1, left, index, depth + 1);
        visit(node.word >> 2, right, index, depth + 1);
    }

    void check_leaf(const scalar::KdNode& node, const Box& cell) {
        const uint32_t count = node.word >> 2;
        entries_ += count;
        ASSERT_LE(node.bits + count, tree_.primitive_ids.size());
        std::vector<bool> is_held(boxes_.size());
        for (uint32_t k = node.bits; k < node.bits + count; ++k) {
            ASSERT_LT(tree_.primitive_ids[k], boxes_.size());
            ASSERT_FALSE(is_held[tree_.primitive_ids[k]]);
            is_held[tree_.primitive_ids[k]] = true;
        }
        for (size_t k = 0; k < boxes_.size(); ++k)
            if (touches(boxes_[k], cell)) ASSERT_TRUE(is_held[k]);
    }

    const KdTree& tree_;
    const std::vector<Box>& boxes_;
    size_t visited_ = 0, entries_ = 0;
    int depth_ = 0;
};

TEST(SahKdTree, holds_in_every_leaf_what_touches_its_cell) {
    std::vector<BoxSet> sets = test::make_box_sets();
    for (const test::TriangleSet& set : test::make_triangle_sets())
        if (!set.triangles.empty()) sets.push_back({set.name, set.boxes()});
    for (const BoxSet& set : sets)
        for (const SahKdTreeBuilder::Config& config : make_kdtree_configs()) {
            SCOPED_TRACE(set.name);
            const KdTree tree = SahKdTreeBuilder::build(set.boxes, config);
            SoundCheck(tree, set.boxes).run();
            EXPECT_LE(double(tree.primitive_ids.size()), config.max_duplication * double(set.boxes.size()));
        }
}

TEST(SahKdTree, is_empty_without_primitives_and_one_leaf_for_one) {
    EXPECT_TRUE(SahKdTreeBuilder::build({}, {}).nodes.empty());
    const KdTree tree = SahKdTreeBuilder::build(std::vector<Box>{Box{{0, 0, 0}, {1, 1, 1}}}, {});
    EXPECT_EQ(tree.nodes.size(), 1u);
    EXPECT_EQ(tree.primitive_ids.size(), 1u);
    EXPECT_TRUE(tree.cells.empty());
}

TEST(SahKdTree, cuts_off_empty_space) {
    // A wall of small boxes at one end of a long scene, and one at the other.
    std::vector<Box> boxes = test::make_random_boxes(100, 200, 1, 0.1f);
    for (const Box& box : test::make_random_boxes(101, 200, 1, 0.1f))
        boxes.push_back({box.lower + Vec3f{100, 0, 0}, box.upper + Vec3f{100, 0, 0}});
    const KdTree tree = SahKdTreeBuilder::build(boxes, {});
    bool has_empty_leaf = false;
    for (const scalar::KdNode& node : tree.nodes) has_empty_leaf |= node.word == scalar::kKdLeaf;
    EXPECT_TRUE(has_empty_leaf);
}

TEST(SahKdTree, keeps_to_its_depth_and_its_duplicates) {
    const std::vector<Box> boxes = test::make_random_boxes(102, 2000, 1, 0.5f);
    for (const int max_depth : {1, 5, 12})
        for (const float max_duplication : {1.0f, 1.5f, 4.0f}) {
            SahKdTreeBuilder::Config config;
            config.traversal_cost = 0.01f;
            config.max_depth = max_depth;
            config.max_duplication = max_duplication;
            config.cells = Cells::kept;
            const KdTree tree = SahKdTreeBuilder::build(boxes, config);
            EXPECT_LE(tree.depth, max_depth);
            EXPECT_LE(double(tree.primitive_ids.size()), max_duplication * double(boxes.size()));
            SoundCheck(tree, boxes).run();
        }
}

TEST(SahKdTree, is_the_same_for_any_number_of_threads) {
    const std::vector<Box> boxes = test::make_random_boxes(103, 20000, 10, 0.2f);
    for (const SahKdTreeBuilder::Config& config : make_kdtree_configs()) {
        KdTree serial, parallel;
        with_threads(1, [&] { serial = SahKdTreeBuilder::build(boxes, config); });
        with_threads(2, [&] { parallel = SahKdTreeBuilder::build(boxes, config); });
        EXPECT_TRUE(test::is_same_bytes(serial.nodes, parallel.nodes));
        EXPECT_TRUE(test::is_same_bytes(serial.cells, parallel.cells));
        EXPECT_EQ(serial.primitive_ids, parallel.primitive_ids);
    }
}

TEST(SahKdTree, costs_less_than_one_leaf_and_grows_with_cheaper_nodes) {
    const std::vector<Box> boxes = test::make_random_boxes(104, 3000, 10, 0.2f);
    SahKdTreeBuilder::Config expensive, cheap;
    cheap.traversal_cost = 0.3f;
    EXPECT_GT(SahKdTreeBuilder::build(boxes, expensive).nodes.size(), 1000u);
    EXPECT_GT(SahKdTreeBuilder::build(boxes, cheap).nodes.size(),
              SahKdTreeBuilder::build(boxes, expensive).nodes.size());
}

/// Rays in the order of restart, push-down, backtrack; every one by all three.
template <test::Intersect kIntersect> class KdRays {
  public:
    explicit KdRays(const std::vector<Triangle>& triangles) : triangles_(triangles) {
        std::vector<Box> boxes;
        for (const Triangle& triangle : triangles) boxes.push_back(triangle.box());
        SahKdTreeBuilder::Config config;
        config.traversal_cost = 0.5f; // deeper than usual: more planes to get wrong
        config.cells = Cells::kept;
        tree_ = SahKdTreeBuilder::build(boxes, config);
    }

    /// Walks that did not give what brute force gives.
    int count_wrong(const BoxRay& ray) {
        const Nearest expected = test::find_by_brute_force<kIntersect>(triangles_, ray);
        hits_ += expected.is_hit();
        return count_wrong<TraversalKind::restart>(ray, expected) +
               count_wrong<TraversalKind::push_down>(ray, expected) +
               count_wrong<TraversalKind::backtrack>(ray, expected);
    }

    int hits() const { return hits_; }
    int depth() const { return tree_.depth; }

  private:
    template <TraversalKind kTraversal> int count_wrong(BoxRay ray, const Nearest& expected) const {
        NearestLeaf<kIntersect> leaf(triangles_);
        const bool is_hit = any_hit<kTraversal>(make_walk_view(tree_), ray, AnyLeaf<kIntersect>(triangles_));
        closest_hit<kTraversal>(make_walk_view(tree_), ray, leaf);
        return leaf.best == expected && is_hit == expected.is_hit() ? 0 : 1;
    }

    const std::vector<Triangle>& triangles_;
    KdTree tree_;
    int hits_ = 0;
};

/// Small, so that brute force is quick.
std::vector<test::TriangleSet> make_small_sets() {
    std::vector<test::TriangleSet> sets;
    for (const uint32_t seed : {110u, 111u, 112u, 113u}) {
        sets.push_back({"random", test::make_random_triangles(seed, 30, 1, 0.6f)});
        sets.push_back({"grid", test::make_grid_triangles(seed, 40, 4 + seed % 3, 1)});
    }
    sets.push_back({"floor", test::make_floor(114, 4, 0, 0)});
    sets.push_back({"noisy floor", test::make_floor_between(115, 4, 0.3f, 6)});
    sets.push_back({"far floor", test::move(test::make_floor(116, 4, 0.3f, 0), {1000, 0, 0})});
    sets.push_back({"far", test::move(test::make_random_triangles(117, 40, 1, 0.5f), {300, 300, -100})});
    return sets;
}

TEST(SahKdTree, has_no_wrong_hit_among_a_million_rays) {
    const std::vector<test::TriangleSet> sets = make_small_sets();
#ifdef RELIEF_DCHECKS
    constexpr int kRays = 50000; // builds with checks are too slow for more
#else
    constexpr int kRays = 1000000;
#endif
    const int rays = kRays / int(sets.size()) + 1;
    for (size_t s = 0; s < sets.size(); ++s) {
        KdRays<test::intersect> walks(sets[s].triangles);
        KdRays<test::intersect_as_engines_do> walks_of_engines(sets[s].triangles);
        test::RayMaker maker(uint32_t(120 + s), sets[s].triangles);
        int wrong = 0, wrong_of_engines = 0, doubtful = 0;
        for (int k = 0; k < rays; ++k) {
            const BoxRay ray = k % 2 ? maker.make_general() : maker.make_special();
            wrong += walks.count_wrong(ray);
            const int differing = walks_of_engines.count_wrong(ray);
            if (differing == 0) continue;
            if (test::is_doubtful(sets[s].triangles, ray))
                ++doubtful;
            else
                wrong_of_engines += differing;
        }
        EXPECT_EQ(wrong, 0) << sets[s].name;
        EXPECT_EQ(wrong_of_engines, 0) << sets[s].name;
        EXPECT_LE(doubtful, rays / 20) << sets[s].name;
        EXPECT_GT(walks.hits(), rays / 10) << sets[s].name;
        EXPECT_GT(walks.depth(), 2) << sets[s].name;
    }
}

} // namespace
} // namespace relief
