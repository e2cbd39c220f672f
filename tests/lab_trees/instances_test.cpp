// Trees whose leaves are trees: a leaf puts another state in place of its walk's, resume_walk() brings that
// back.
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <utility>

#include "bvh/sah_bvh.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/walks/walks.h"
#include "support/dense_heap.h"
#include "support/ray_cases.h"

namespace relief::scalar {
namespace {

using test::Nearest;
using test::Triangle;

constexpr uint kKindInstance = 1u << 28;

struct Instance {
    Vec3f offset;
    uint root = 0;      ///< of links: node
    uint heap_base = 0; ///< of heaps: slot of key 0
    uint first = 0;     ///< triangle
    uint count = 0;     ///< of triangles
};

/// All trees in the same arrays, the upper one first.
struct Forest {
    std::vector<TreeNode> nodes, slots;
    std::vector<uint32_t> parents, skips;
    std::vector<Instance> instances;
    std::vector<Triangle> triangles; ///< in the order of leaves

    uint add_links(const LinkedBvh& tree, uint first_entry, uint kind) {
        const uint base = uint(nodes.size());
        for (TreeNode node : tree.nodes) {
            const bool is_leaf = is_leaf_word(node.word);
            node.first =
                is_leaf ? enter(tree.primitive_ids, node.first, first_entry, kind) : node.first + base;
            if (is_leaf) node.word |= kind;
            nodes.push_back(node);
        }
        for (const uint32_t parent : tree.parents)
            parents.push_back(parent == kNoNode ? kNoNode : parent + base);
        for (const uint32_t skip : tree.skips) skips.push_back(skip == kNoNode ? kNoNode : skip + base);
        return base;
    }

    uint add_heap(const DenseHeap& tree, uint first_entry, uint kind) {
        const uint base = uint(slots.size());
        for (TreeNode node : tree.nodes) {
            if (node.word != kEmptySlot && is_leaf_word(node.word)) {
                node.first = enter(tree.primitive_ids, node.first, first_entry, kind);
                node.word |= kind;
            }
            slots.push_back(node);
        }
        return base;
    }

  private:
    /// Leaves of the scene tree name their instance, others their first triangle.
    static uint enter(const std::vector<uint32_t>& ids, uint first, uint first_entry, uint kind) {
        return kind == 0 ? first + first_entry : ids[first];
    }
};

/// Moved copies of a few bodies, each with a tree of its own space.
class ForestMaker {
  public:
    Forest run() {
        std::mt19937 random(130);
        std::vector<Box> boxes;
        std::vector<uint32_t> bodies;
        for (int k = 0; k < 60; ++k) {
            bodies.push_back(random() % 3);
            forest_.instances.push_back({test::make_point(random, 6)});
            Box box;
            for (const Triangle& triangle : make_body(bodies.back())) box.extend(triangle.box());
            const Vec3f offset = forest_.instances.back().offset;
            // Moving rounds.
            const Vec3f margin{1e-5f, 1e-5f, 1e-5f};
            boxes.push_back({box.lower + offset - margin, box.upper + offset + margin});
        }
        add_tree(boxes, 1, 0, kKindInstance);
        for (uint32_t body = 0; body < 3; ++body) add_body(body, bodies);
        return std::move(forest_);
    }

    static std::vector<Triangle> make_body(uint32_t body) {
        return test::make_random_triangles(140 + body, 1 + 40 * body, 1, 0.5f);
    }

  private:
    struct Roots {
        uint node, heap_base;
        std::vector<uint32_t> ids;
    };

    Roots add_tree(const std::vector<Box>& boxes, uint32_t leaf_size, uint first_entry, uint kind) {
        SahBvhBuilder::Config config;
        config.max_leaf_size = leaf_size;
        config.max_depth = 12;
        const Bvh bvh = SahBvhBuilder::build(boxes, config);
        const std::vector<uint8_t> axes = compute_axes(bvh);
        const uint node =
            forest_.add_links(make_linked_bvh({bvh, axes, compute_depth(bvh)}), first_entry, kind);
        return {node, forest_.add_heap(test::make_dense_heap(bvh, axes), first_entry, kind),
                bvh.primitive_ids};
    }

    void add_body(uint32_t body, const std::vector<uint32_t>& bodies) {
        const std::vector<Triangle> triangles = make_body(body);
        std::vector<Box> boxes;
        for (const Triangle& triangle : triangles) boxes.push_back(triangle.box());
        const uint first = uint(forest_.triangles.size());
        const Roots roots = add_tree(boxes, 4, first, 0);
        for (const uint32_t id : roots.ids) forest_.triangles.push_back(triangles[id]);
        for (size_t k = 0; k < bodies.size(); ++k) {
            Instance& instance = forest_.instances[k];
            if (bodies[k] == body)
                instance = {instance.offset, roots.node, roots.heap_base, first, uint(triangles.size())};
        }
    }

    Forest forest_;
};

/// All that a shader would have as global variables.
template <TraversalKind kTraversal> class ForestWalker {
  public:
    using Key = uint;

    ForestWalker(const Forest& forest, const BoxRay& ray) : forest_(forest), world_(ray), ray_(ray) {
        object_ray_ = make_object_ray(ray.origin, ray.direction);
        if constexpr (kTraversal == TraversalKind::stack) stack_walk = make_empty_stack();
        start({{}});
    }

    Nearest run() {
        bool is_complete = false;
        if constexpr (kTraversal == TraversalKind::stack) is_complete = walk_stack();
        if constexpr (kTraversal == TraversalKind::restart_trail) is_complete = walk_restart_trail();
        if constexpr (kTraversal == TraversalKind::parent_link) is_complete = walk_parent_link();
        if constexpr (kTraversal == TraversalKind::skip_link) is_complete = walk_skip_link();
        if constexpr (kTraversal == TraversalKind::trail) is_complete = walk_trail();
        if constexpr (kTraversal == TraversalKind::pair_trail) is_complete = walk_pair_trail();
        EXPECT_TRUE(is_complete);
        return best_;
    }

  private:
    void start(const Instance& tree) {
        heap_base_ = tree.heap_base;
        if constexpr (kTraversal == TraversalKind::stack) start_stack(tree.root);
        if constexpr (kTraversal == TraversalKind::restart_trail)
            restart_walk = start_restart_trail(tree.root, make_root_level32());
        if constexpr (kTraversal == TraversalKind::parent_link) parent_walk = start_parent_link(tree.root);
        if constexpr (kTraversal == TraversalKind::skip_link) skip_walk = start_skip_link(tree.root);
        if constexpr (kTraversal == TraversalKind::trail) trail_walk = start_trail(1u);
        if constexpr (kTraversal == TraversalKind::pair_trail) pair_walk = start_pair_trail(1u);
    }

    bool visit_leaf(uint first, uint word, uint) {
        if ((word & kKindInstance) != 0u) {
            enter_instance(first);
            return false;
        }
        for (uint k = first; k < first + get_word_count(word); ++k) {
            const float t = test::intersect(ray_, forest_.triangles[k]);
            const uint32_t id = instance_ * 1000 + k;
            if (t == std::numeric_limits<float>::infinity()) continue;
            if (t < best_.t || (t == best_.t && id < best_.id)) best_ = {t, id}, ray_.t_max = t;
        }
        return false;
    }

    void enter_instance(uint index) {
        restore_ = [this, saved = state()] { state() = saved; };
        instance_ = index;
        set_origin(world_.origin - forest_.instances[index].offset);
        start(forest_.instances[index]);
    }

    bool resume_walk() {
        if (!restore_) return false;
        restore_();
        restore_ = nullptr;
        if constexpr (kTraversal == TraversalKind::restart_trail)
            restart_walk = drop_short_stack(restart_walk);
        heap_base_ = 0;
        set_origin(world_.origin);
        return true;
    }

    auto& state() {
        if constexpr (kTraversal == TraversalKind::stack) return stack_walk;
        if constexpr (kTraversal == TraversalKind::restart_trail) return restart_walk;
        if constexpr (kTraversal == TraversalKind::parent_link) return parent_walk;
        if constexpr (kTraversal == TraversalKind::skip_link) return skip_walk;
        if constexpr (kTraversal == TraversalKind::trail) return trail_walk;
        if constexpr (kTraversal == TraversalKind::pair_trail) return pair_walk;
    }

    void set_origin(const Vec3f& origin) {
        ray_.origin = origin;
        object_ray_ = make_object_ray(origin, ray_.direction);
    }

    TreeNode load_node(uint node) {
        // A walk that is brought back wrongly may never end.
        if (++loads_ > 100'000) throw std::runtime_error("the walk does not end");
        constexpr bool kIsHeap =
            kTraversal == TraversalKind::trail || kTraversal == TraversalKind::pair_trail;
        return kIsHeap ? forest_.slots[node] : forest_.nodes[node];
    }
    uint load_parent(uint node) const { return forest_.parents[node]; }
    uint load_skip(uint node) const { return forest_.skips[node]; }
    uint find_slot(uint key) const { return heap_base_ + key; }
    float get_limit() const { return ray_.t_max; }
    float enter_box(const TreeNode& node) const {
        return cross_node(object_ray_, node, ray_.t_min, ray_.t_max);
    }
    float enter_whole_box(const TreeNode& node) const {
        return cross_node(object_ray_, node, ray_.t_min, world_.t_max);
    }
    bool is_axis_backward(uint axis) const { return select_axis(ray_.direction, axis) < 0.0f; }
    void count_box_test() const {}
    void count_restart() const {}
    void count_bytes(uint) const {}

#include "lab/walks/traverse_pair_trail.h"
#include "lab/walks/traverse_parent_link.h"
#include "lab/walks/traverse_restart_trail.h"
#include "lab/walks/traverse_skip_link.h"
#include "lab/walks/traverse_stack.h"
#include "lab/walks/traverse_trail.h"

    const Forest& forest_;
    const BoxRay world_;
    BoxRay ray_;
    ObjectRay object_ray_;
    Nearest best_;
    std::function<void()> restore_; ///< the state outside of the instance
    uint instance_ = 0, heap_base_ = 0;
    int loads_ = 0;
};

Nearest find_by_brute_force(const Forest& forest, BoxRay ray) {
    Nearest best;
    const Vec3f origin = ray.origin;
    for (uint32_t k = 0; k < forest.instances.size(); ++k) {
        const Instance& instance = forest.instances[k];
        ray.origin = origin - instance.offset;
        for (uint32_t id = instance.first; id < instance.first + instance.count; ++id) {
            const float t = test::intersect(ray, forest.triangles[id]);
            if (t < best.t) best = {t, k * 1000 + id};
        }
    }
    return best;
}

TEST(Instances, are_met_by_every_walk_that_enters_them) {
    const Forest forest = ForestMaker().run();
    int hits = 0;
    for (const BoxRay& ray : test::make_rays(131, 2000, 6)) {
        const Nearest expected = find_by_brute_force(forest, ray);
        hits += expected.is_hit();
        ASSERT_EQ(ForestWalker<TraversalKind::stack>(forest, ray).run(), expected);
        ASSERT_EQ(ForestWalker<TraversalKind::restart_trail>(forest, ray).run(), expected);
        ASSERT_EQ(ForestWalker<TraversalKind::parent_link>(forest, ray).run(), expected);
        ASSERT_EQ(ForestWalker<TraversalKind::skip_link>(forest, ray).run(), expected);
        ASSERT_EQ(ForestWalker<TraversalKind::trail>(forest, ray).run(), expected);
        ASSERT_EQ(ForestWalker<TraversalKind::pair_trail>(forest, ray).run(), expected);
    }
    EXPECT_GT(hits, 500);
}

} // namespace
} // namespace relief::scalar
