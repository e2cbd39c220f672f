// Every walk over a kd-tree visits the leaves that recursion along the planes visits, in the same order, each
// once.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "support/box_sets.h"
#include "support/walks_from_root.h"

namespace relief {
namespace {

/// Nearer side of a plane first. An entry of a leaf may shorten the ray to its limit.
class RecursiveKdWalk {
  public:
    RecursiveKdWalk(const KdTree& tree, const BoxRay& ray, const std::vector<float>& limits)
        : tree_(tree),
          limits_(limits),
          t_max_(ray.t_max),
          ray_(scalar::make_kd_ray(scalar::make_object_ray(ray.origin, ray.direction), tree.bounds.lower,
                                   tree.bounds.upper, ray.t_min, ray.t_max)) {}

    std::vector<uint32_t> run() {
        if (ray_.end >= 0) visit(0, 0, ray_.end);
        return entries_;
    }

  private:
    void visit(uint32_t index, float near, float far) {
        if (scalar::is_kd_walk_over(ray_, near, t_max_)) return;
        const scalar::KdNode& node = tree_.nodes[index];
        const uint32_t axis = node.word & 3u;
        if (axis == scalar::kKdLeaf) return visit_leaf(node);
        const float plane = std::bit_cast<float>(node.bits);
        const float speed = get_component(ray_.direction, int(axis));
        const uint32_t left = index + 1, right = node.word >> 2;
        if (speed == 0)
            return visit(get_component(ray_.origin, int(axis)) <= plane ? left : right, near, far);
        const float t = scalar::cross_plane(ray_, axis, plane);
        const uint32_t first = speed > 0 ? left : right, second = speed > 0 ? right : left;
        if (t <= near) return visit(second, near, far);
        if (t >= far) return visit(first, near, far);
        visit(first, near, t);
        visit(second, t, far);
    }

    void visit_leaf(const scalar::KdNode& node) {
        for (uint32_t k = node.bits; k < node.bits + (node.word >> 2); ++k) {
            const uint32_t entry = tree_.primitive_ids[k];
            entries_.push_back(entry);
            t_max_ = std::min(t_max_, limits_[entry]);
        }
    }

    const KdTree& tree_;
    const std::vector<float>& limits_;
    float t_max_;
    const scalar::KdRay ray_;
    std::vector<uint32_t> entries_;
};

/// Its ids are numbers of entries, so that each names its leaf, too.
KdTree make_numbered_tree(const std::vector<Box>& boxes, float traversal_cost) {
    SahKdTreeBuilder::Config config;
    config.traversal_cost = traversal_cost;
    config.cells = SahKdTreeBuilder::Cells::kept;
    KdTree tree = SahKdTreeBuilder::build(boxes, config);
    std::iota(tree.primitive_ids.begin(), tree.primitive_ids.end(), 0u);
    return tree;
}

struct Sums {
    size_t visited = 0;
    uint64_t restarts = 0;
};

template <TraversalKind kTraversal>
void expect_order(const KdTree& tree, const BoxRay& ray, const std::vector<float>& limits,
                  const std::vector<uint32_t>& expected, Sums& sums) {
    std::vector<uint32_t> entries;
    WalkCounts counts;
    BoxRay shortened = ray;
    closest_hit<kTraversal>(
        make_walk_view(tree), shortened,
        [&](uint32_t entry, BoxRay& r) {
            entries.push_back(entry);
            r.t_max = std::min(r.t_max, limits[entry]);
        },
        counts);
    ASSERT_EQ(entries, expected) << "traversal " << int(kTraversal);
    sums.visited += entries.size(), sums.restarts += counts.restarts;
    std::sort(entries.begin(), entries.end());
    ASSERT_EQ(std::adjacent_find(entries.begin(), entries.end()), entries.end()) << "a leaf twice";
    if (expected.empty()) return;
    const size_t last = expected.size() / 2;
    size_t count = 0;
    BoxRay other = ray;
    const auto stop = [&](uint32_t entry, BoxRay& r) {
        ++count;
        r.t_max = std::min(r.t_max, limits[entry]);
        return entry == expected[last];
    };
    ASSERT_TRUE(any_hit<kTraversal>(make_walk_view(tree), other, stop));
    ASSERT_EQ(count, last + 1);
}

/// Half of the rays are shortened on the way.
void check_tree(const KdTree& tree, const std::vector<BoxRay>& rays, float size, Sums& sums) {
    std::mt19937 random(uint32_t(tree.nodes.size()));
    std::uniform_real_distribution<float> reach(0, 6 * size);
    for (size_t k = 0; k < rays.size(); ++k) {
        std::vector<float> limits(tree.primitive_ids.size(), std::numeric_limits<float>::infinity());
        if (k % 2)
            for (float& limit : limits)
                if (random() % 4 == 0) limit = reach(random);
        const std::vector<uint32_t> expected = RecursiveKdWalk(tree, rays[k], limits).run();
        expect_order<TraversalKind::restart>(tree, rays[k], limits, expected, sums);
        expect_order<TraversalKind::push_down>(tree, rays[k], limits, expected, sums);
        expect_order<TraversalKind::backtrack>(tree, rays[k], limits, expected, sums);
    }
}

TEST(KdLeafOrder, is_that_of_recursion_along_the_planes) {
    Sums sums;
    for (const uint32_t seed : {201u, 202u, 203u, 204u})
        for (const float cost : {3.0f, 0.1f}) {
            const std::vector<Box> boxes = test::make_random_boxes(seed, 30 * (seed - 200), 1, 0.3f);
            check_tree(make_numbered_tree(boxes, cost), test::make_rays(seed, 600, 1), 1, sums);
        }
    EXPECT_GT(sums.visited, 50000u);
    EXPECT_GT(sums.restarts, 10000u);
}

TEST(KdLeafOrder, is_that_of_recursion_where_planes_coincide) {
    // Faces of a lattice: rays along its planes and through its edges cross several planes at once.
    std::vector<Box> boxes;
    for (int k = 0; k < 64; ++k) {
        const Vec3f lower{float(k % 4), float(k / 4 % 4), float(k / 16)};
        boxes.push_back({lower, lower + Vec3f{1, 1, 1}});
    }
    std::vector<BoxRay> rays;
    for (int k = 0; k < 4 * 81; ++k) {
        const Vec3f target{float(k % 3 + 1), float(k / 3 % 3 + 1), float(k / 9 % 3 + 1)};
        const Vec3f directions[] = {{1, 1, 1}, {-1, 1, 0}, {0, 0, -1}, {2, -1, 1}};
        const Vec3f direction = directions[k / 81];
        rays.push_back({target - direction * float(k / 27 % 3 + 2), direction});
    }
    Sums sums;
    const KdTree tree = make_numbered_tree(boxes, 0.1f);
    const std::vector<float> limits(tree.primitive_ids.size(), std::numeric_limits<float>::infinity());
    for (const BoxRay& ray : rays) {
        const std::vector<uint32_t> expected = RecursiveKdWalk(tree, ray, limits).run();
        expect_order<TraversalKind::restart>(tree, ray, limits, expected, sums);
        expect_order<TraversalKind::push_down>(tree, ray, limits, expected, sums);
        expect_order<TraversalKind::backtrack>(tree, ray, limits, expected, sums);
    }
    EXPECT_GT(sums.visited, 5000u);
}

} // namespace
} // namespace relief
