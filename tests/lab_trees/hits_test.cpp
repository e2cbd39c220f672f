// Every builder and every walk that is valid for its tree: the hits of brute force, ray for ray.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <utility>

#include "bvh/sah_bvh.h"
#include "formulas/tree.h"
#include "lab/trees/lbvh.h"
#include "lab/walks/trail.h"
#include "support/dense_heap.h"
#include "support/ray_cases.h"
#include "support/walks_from_root.h"

namespace relief {
namespace {

using test::AnyLeaf;
using test::Nearest;
using test::NearestLeaf;
using test::Triangle;
using test::TriangleSet;

/// One tree with one walk.
struct WalkCase {
    std::string name;
    std::function<Nearest(BoxRay, WalkCounts&)> find_nearest;
    std::function<bool(const BoxRay&)> find_any;
    WalkCounts counts;
};

template <test::Intersect kIntersect> class CaseMaker {
  public:
    explicit CaseMaker(const TriangleSet& set) : triangles_(set.triangles), boxes_(set.boxes()) {}

    std::vector<WalkCase> run() {
        add_sah("binned SAH", SahBvhBuilder::Method::binned, 4, 1, 1);
        add_sah("swept SAH of paper 3", SahBvhBuilder::Method::sweep, 8, 3.0f, 1.5f);
        for (const int code_bits : {30, 63})
            for (const uint32_t leaf_size : {1u, scalar::kNodeCountMask}) {
                const std::string name =
                    "LBVH " + std::to_string(code_bits) + "/" + std::to_string(leaf_size);
                const AxisBvh tree = LbvhBuilder::build(boxes_, {code_bits, leaf_size});
                add_walks(name, tree.bvh, tree.axes);
            }
        for (const int levels : {4, 0})
            add_dense("heap of paper 2", LbvhBuilder::build_heap(boxes_, {30, levels}));
        for (const float empty_factor : {1.0f, 0.8f}) add_kd(empty_factor);
        return std::move(cases_);
    }

  private:
    void add_sah(const std::string& name, SahBvhBuilder::Method method, uint32_t leaf_size,
                 float traversal_cost, float intersection_cost) {
        SahBvhBuilder::Config config;
        config.method = method;
        config.max_leaf_size = leaf_size;
        config.traversal_cost = traversal_cost;
        config.intersection_cost = intersection_cost;
        for (const int max_depth : {int(scalar::kTrailLevels32), int(scalar::kTrailLevels64)}) {
            config.max_depth = max_depth;
            const Bvh bvh = SahBvhBuilder::build(boxes_, config);
            add_walks(name, bvh, compute_axes(bvh));
        }
    }

    void add_walks(const std::string& name, const Bvh& bvh, const std::vector<uint8_t>& axes) {
        const auto linked =
            std::make_shared<const LinkedBvh>(make_linked_bvh({bvh, axes, compute_depth(bvh)}));
        const auto view = make_walk_view(*linked);
        add<TraversalKind::stack>(name + ", stack", linked, view);
        add<TraversalKind::parent_link>(name + ", parent links", linked, view);
        add<TraversalKind::skip_link>(name + ", skip links", linked, view);
        const bool is_narrow = linked->depth <= int(scalar::kTrailLevels32);
        if (is_narrow) add<TraversalKind::restart_trail>(name + ", restart trail", linked, view);
        add<TraversalKind::restart_trail>(name + ", wide restart trail", linked,
                                          make_wide_walk_view(*linked));
        const auto heap =
            std::make_shared<const SuccinctHeap>(make_succinct_heap({bvh, axes, compute_depth(bvh)}));
        if (is_narrow) {
            add<TraversalKind::trail>(name + ", trail", heap, make_walk_view(*heap));
            add<TraversalKind::pair_trail>(name + ", pair trail", heap, make_walk_view(*heap));
        }
        add<TraversalKind::trail>(name + ", wide trail", heap, make_wide_walk_view(*heap));
        add<TraversalKind::pair_trail>(name + ", wide pair trail", heap, make_wide_walk_view(*heap));
        if (linked->depth < 18) add_dense(name + ", dense", test::make_dense_heap(bvh, axes));
    }

    void add_dense(const std::string& name, DenseHeap heap) {
        const auto shared = std::make_shared<const DenseHeap>(std::move(heap));
        add<TraversalKind::trail>(name + ", trail", shared, make_walk_view(*shared));
        add<TraversalKind::pair_trail>(name + ", pair trail", shared, make_walk_view(*shared));
    }

    void add_kd(float empty_factor) {
        SahKdTreeBuilder::Config config;
        config.empty_factor = empty_factor;
        config.cells = SahKdTreeBuilder::Cells::kept;
        const auto tree = std::make_shared<const KdTree>(SahKdTreeBuilder::build(boxes_, config));
        add<TraversalKind::restart>("kd-tree, restart", tree, make_walk_view(*tree));
        add<TraversalKind::push_down>("kd-tree, push-down", tree, make_walk_view(*tree));
        add<TraversalKind::backtrack>("kd-tree, backtrack", tree, make_walk_view(*tree));
    }

    template <TraversalKind kTraversal, class Tree, class View>
    void add(const std::string& name, std::shared_ptr<const Tree> tree, const View& view) {
        WalkCase walk;
        walk.name = name;
        // The tree lives as long as the functions; the view refers to it.
        walk.find_nearest = [this_triangles = &triangles_, tree, view](BoxRay ray, WalkCounts& counts) {
            NearestLeaf<kIntersect> leaf(*this_triangles);
            closest_hit<kTraversal>(view, ray, leaf, counts);
            return leaf.best;
        };
        walk.find_any = [this_triangles = &triangles_, tree, view](const BoxRay& ray) {
            return any_hit<kTraversal>(view, ray, AnyLeaf<kIntersect>(*this_triangles));
        };
        cases_.push_back(std::move(walk));
    }

    const std::vector<Triangle>& triangles_;
    std::vector<Box> boxes_;
    std::vector<WalkCase> cases_;
};

class Hits : public testing::TestWithParam<TriangleSet> {};

TEST_P(Hits, of_every_walk_are_those_of_brute_force) {
    const TriangleSet& set = GetParam();
    std::vector<WalkCase> walks = CaseMaker<test::intersect>(set).run();
    test::RayMaker maker(90, set.triangles);
    constexpr int kRays = 500;
    int hits = 0;
    for (int k = 0; k < kRays; ++k) {
        const BoxRay ray = k % 2 ? maker.make_general() : maker.make_special();
        const Nearest expected = test::find_by_brute_force(set.triangles, ray);
        hits += expected.is_hit();
        for (WalkCase& walk : walks) {
            ASSERT_EQ(walk.find_nearest(ray, walk.counts), expected) << walk.name << ", ray " << k;
            ASSERT_EQ(walk.find_any(ray), expected.is_hit()) << walk.name << ", ray " << k;
        }
    }
    if (set.triangles.size() >= 100) {
        EXPECT_GT(hits, kRays / 20);
    }
    if (set.name != "many small") return;
    for (const WalkCase& walk : walks) {
        const bool is_one_leaf_heap = walk.name.starts_with("heap of paper 2");
        EXPECT_LT(walk.counts.primitive_tests, set.triangles.size() * kRays / (is_one_leaf_heap ? 3 : 20))
            << walk.name;
        EXPECT_GT(walk.counts.bytes, 0u) << walk.name;
    }
}

TEST_P(Hits, by_the_test_of_the_engines_differ_only_where_a_ray_misses_the_box_of_what_it_hits) {
    const TriangleSet& set = GetParam();
    std::vector<WalkCase> walks = CaseMaker<test::intersect_as_engines_do>(set).run();
    test::RayMaker maker(95, set.triangles);
    constexpr int kRays = 500;
    int doubtful = 0;
    for (int k = 0; k < kRays; ++k) {
        const BoxRay ray = k % 2 ? maker.make_general() : maker.make_special();
        if (test::is_doubtful(set.triangles, ray)) {
            ++doubtful;
            continue;
        }
        const Nearest expected = test::find_by_brute_force<test::intersect_as_engines_do>(set.triangles, ray);
        for (WalkCase& walk : walks) {
            ASSERT_EQ(walk.find_nearest(ray, walk.counts), expected) << walk.name << ", ray " << k;
            ASSERT_EQ(walk.find_any(ray), expected.is_hit()) << walk.name << ", ray " << k;
        }
    }
    EXPECT_LE(doubtful, kRays / 8); // grids and floors: half of the rays aim at what they share
}

/// A chain of rays, each from the leaf where the one before was hit.
template <TraversalKind kTraversal, class View>
void expect_same_from_last_hit(const View& view, const std::vector<Triangle>& triangles, uint32_t seed) {
    test::RayMaker maker(seed, triangles);
    auto closest_start = scalar::make_root_key(typename View::Key{}), any_start = closest_start;
    for (int k = 0; k < 400; ++k) {
        BoxRay ray = k % 2 ? maker.make_general() : maker.make_special();
        const Nearest expected = test::find_by_brute_force(triangles, ray);
        ASSERT_EQ(any_hit_from<kTraversal>(view, any_start, ray, AnyLeaf(triangles)), expected.is_hit());
        NearestLeaf leaf(triangles);
        closest_hit_from<kTraversal>(view, closest_start, ray, leaf);
        ASSERT_EQ(leaf.best, expected);
    }
}

TEST_P(Hits, from_the_leaf_of_the_last_hit_are_those_of_brute_force) {
    const TriangleSet& set = GetParam();
    if (set.triangles.empty()) return;
    const DenseHeap paper = LbvhBuilder::build_heap(set.boxes(), {});
    expect_same_from_last_hit<TraversalKind::trail>(make_walk_view(paper), set.triangles, 91);
    expect_same_from_last_hit<TraversalKind::pair_trail>(make_walk_view(paper), set.triangles, 92);
    SahBvhBuilder::Config config;
    config.max_depth = int(scalar::kTrailLevels64);
    const Bvh bvh = SahBvhBuilder::build(set.boxes(), config);
    const SuccinctHeap heap = make_succinct_heap(add_axes(bvh));
    expect_same_from_last_hit<TraversalKind::trail>(make_wide_walk_view(heap), set.triangles, 93);
    expect_same_from_last_hit<TraversalKind::pair_trail>(make_wide_walk_view(heap), set.triangles, 94);
}

INSTANTIATE_TEST_SUITE_P(Sets, Hits, testing::ValuesIn(test::make_triangle_sets()),
                         [](const testing::TestParamInfo<TriangleSet>& info) {
                             std::string name = info.param.name;
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

} // namespace
} // namespace relief
