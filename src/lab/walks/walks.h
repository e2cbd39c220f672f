// The walks of lab/walks/traverse_*.h over the trees of this folder: the reference for the kernels of a
// device, and what the CPU runs when a traversal is named.
//   closest_hit<TraversalKind::trail>(make_walk_view(heap), ray, leaf);
#pragma once

#include <cstdint>
#include <type_traits>

#include "base/check.h"
#include "bvh/tree_links.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/trees/heap_tree.h"
#include "lab/trees/ray_box.h"
#include "lab/trees/sah_kdtree.h"
#include "lab/walks/trail.h"
#include "relief/traversal.h"

namespace relief {

/// What a walk did; added up over rays.
struct WalkCounts {
    uint64_t box_tests = 0;
    uint64_t primitive_tests = 0;
    uint64_t restarts = 0;
    uint64_t bytes = 0; ///< of nodes, links and directories; not of primitives
};

/// Where nobody counts.
struct NoCounts {};

namespace scalar {

/// `Width`: uint or HeapKey, for the restart trail: trees of 30 or 62 levels.
template <class Width> struct BvhWalkView {
    using Key = Width;
    const LinkedBvh& tree;

    bool is_empty() const { return tree.nodes.empty(); }
    TreeNode load_node(uint node) const { return tree.nodes[node]; }
    uint load_parent(uint node) const { return tree.parents[node]; }
    uint load_skip(uint node) const { return tree.skips[node]; }
    const std::vector<uint32_t>& primitive_ids() const { return tree.primitive_ids; }
};

struct DenseWalkView {
    using Key = uint;
    const DenseHeap& tree;

    bool is_empty() const { return tree.slots.empty(); }
    TreeNode load_node(uint slot) const { return tree.slots[slot]; }
    const std::vector<uint32_t>& primitive_ids() const { return tree.primitive_ids; }
};

/// `Width`: uint or HeapKey: trees of 30 or 62 levels.
template <class Width> struct SuccinctWalkView {
    using Key = Width;
    const SuccinctHeap& tree;

    bool is_empty() const { return tree.nodes.empty(); }
    TreeNode load_node(uint slot) const { return tree.nodes[slot]; }
    HeapForm get_heap_form() const { return tree.form; }
    HeapBlock load_heap_block(uint block) const { return tree.blocks[block]; }
    HeapBrick load_heap_brick(uint brick) const { return tree.bricks[brick]; }
    const std::vector<uint32_t>& primitive_ids() const { return tree.primitive_ids; }
};

struct KdWalkView {
    using Key = uint;
    const KdTree& tree;

    bool is_empty() const { return tree.nodes.empty(); }
    KdNode load_kd_node(uint node) const { return tree.nodes[node]; }
    KdBox load_kd_box(uint node) const { return tree.cells[node]; }
    const std::vector<uint32_t>& primitive_ids() const { return tree.primitive_ids; }
};

/// All walks in one class: their hooks are the same, and only the members that a walk uses are ever made.
/// `Leaf` is called as leaf(primitive_id, ray), may shorten ray.t_max, and ends the walk by true.
template <TraversalKind kTraversal, class View, class Leaf, class Counts> class Walker {
  public:
    using Key = typename View::Key;

    Walker(const View& view, BoxRay& ray, Leaf& leaf, Counts& counts)
        : view_(view),
          ray_(ray),
          leaf_(leaf),
          counts_(counts),
          whole_t_max_(ray.t_max),
          object_ray_(make_object_ray(ray.origin, ray.direction)) {}

    /// True: a leaf ended the walk. `start`: key of the node to start at, for the two trails.
    bool run(Key start) {
        hit_leaf_ = start;
        if (view_.is_empty()) return false;
        if constexpr (kTraversal == TraversalKind::stack) stack_walk = make_empty_stack();
        if constexpr (kTraversal == TraversalKind::backtrack) DCHECK(!view_.tree.cells.empty());
        start_walk(0u, start);
        const bool is_complete = run_walk();
        DCHECK(is_complete);
        static_cast<void>(is_complete);
        return is_ended_;
    }

    /// Key of the leaf that ended the walk or shortened the ray last, by a trail; the start where none did.
    Key hit_leaf() const { return hit_leaf_; }

  private:
    KdRay make_own_kd_ray() const {
        return make_kd_ray(object_ray_, view_.tree.bounds.lower, view_.tree.bounds.upper, ray_.t_min,
                           ray_.t_max);
    }

    static constexpr bool kIsCounting = requires(Counts & counts) { counts.bytes; };

    // The hooks of formulas/tree.h.
    TreeNode load_node(uint node) const { return view_.load_node(node); }
    uint load_parent(uint node) const { return view_.load_parent(node); }
    uint load_skip(uint node) const { return view_.load_skip(node); }
    HeapForm get_heap_form() const { return view_.get_heap_form(); }
    HeapBlock load_heap_block(uint block) const { return view_.load_heap_block(block); }
    HeapBrick load_heap_brick(uint brick) const { return view_.load_heap_brick(brick); }
    KdNode load_kd_node(uint node) const { return view_.load_kd_node(node); }
    KdBox load_kd_box(uint node) const { return view_.load_kd_box(node); }

    float get_limit() const { return ray_.t_max; }
    float enter_box(const TreeNode& node) const {
        return cross_node(object_ray_, node, ray_.t_min, ray_.t_max);
    }
    float enter_whole_box(const TreeNode& node) const {
        return cross_node(object_ray_, node, ray_.t_min, whole_t_max_);
    }
    bool is_axis_backward(uint axis) const { return select_axis(ray_.direction, axis) < 0.0f; }
    bool resume_walk() const { return false; }

    bool visit_leaf(uint first, uint word, uint) {
        const float limit = ray_.t_max;
        for (uint k = 0; k < get_word_count(word) && !is_ended_; ++k) {
            if constexpr (kIsCounting) ++counts_.primitive_tests;
            is_ended_ = leaf_(view_.primitive_ids()[first + k], ray_);
        }
        if (is_ended_ || ray_.t_max < limit) {
            if constexpr (kTraversal == TraversalKind::trail) hit_leaf_ = trail_walk.leaf;
            if constexpr (kTraversal == TraversalKind::pair_trail) hit_leaf_ = pair_walk.leaf;
        }
        return is_ended_;
    }

    uint find_slot(Key key) {
        if constexpr (requires { view_.get_heap_form(); })
            return find_succinct_slot(key);
        else
            return get_low_word(key);
    }

    void count_box_test() {
        if constexpr (kIsCounting) ++counts_.box_tests;
    }
    void count_restart() {
        if constexpr (kIsCounting) ++counts_.restarts;
    }
    void count_bytes(uint bytes) {
        if constexpr (kIsCounting) counts_.bytes += bytes;
    }

#include "lab/walks/walk_members-inl.h"

    const View view_;
    BoxRay& ray_;
    Leaf& leaf_;
    Counts& counts_;
    const float whole_t_max_;
    const ObjectRay object_ray_;
    Key hit_leaf_;
    bool is_ended_ = false;
};

inline uint make_root_key(uint) { return 1u; }
inline HeapKey make_root_key(HeapKey) { return {1u, 0u}; }

} // namespace scalar

/// As narrow as the tree's depth allows; `wide` views for trees of more than kTrailLevels32 levels.
inline scalar::BvhWalkView<uint32_t> make_walk_view(const LinkedBvh& tree) { return {tree}; }
inline scalar::BvhWalkView<scalar::HeapKey> make_wide_walk_view(const LinkedBvh& tree) { return {tree}; }
inline scalar::DenseWalkView make_walk_view(const DenseHeap& tree) { return {tree}; }
inline scalar::SuccinctWalkView<uint32_t> make_walk_view(const SuccinctHeap& tree) { return {tree}; }
inline scalar::SuccinctWalkView<scalar::HeapKey> make_wide_walk_view(const SuccinctHeap& tree) {
    return {tree};
}
inline scalar::KdWalkView make_walk_view(const KdTree& tree) { return {tree}; }

/// As closest_hit below. The two trails may start at any node, `start`, which becomes the leaf of the hit, if
/// there is one: rays that follow one another often end at the same things. Others start at the root.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
void closest_hit_from(const View& view, typename View::Key& start, BoxRay& ray, Leaf&& leaf,
                      Counts&& counts = {}) {
    auto visit = [&](uint32_t id, BoxRay& r) {
        leaf(id, r);
        return false;
    };
    scalar::Walker<kTraversal, View, decltype(visit), std::remove_reference_t<Counts>> walker(view, ray,
                                                                                              visit, counts);
    walker.run(start);
    start = walker.hit_leaf();
}

/// As any_hit below, likewise.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
bool any_hit_from(const View& view, typename View::Key& start, BoxRay ray, Leaf&& leaf,
                  Counts&& counts = {}) {
    scalar::Walker<kTraversal, View, std::remove_reference_t<Leaf>, std::remove_reference_t<Counts>> walker(
        view, ray, leaf, counts);
    const bool is_hit = walker.run(start);
    start = walker.hit_leaf();
    return is_hit;
}

/// Calls `leaf(primitive_id, ray)` for every primitive whose box the ray may meet before ray.t_max (in a
/// kd-tree perhaps several times); the leaf shortens ray.t_max to its hits. Where hits tie, the leaf decides.
/// `counts`: WalkCounts to add to, or NoCounts.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
void closest_hit(const View& view, BoxRay& ray, Leaf&& leaf, Counts&& counts = {}) {
    auto start = scalar::make_root_key(typename View::Key{});
    closest_hit_from<kTraversal>(view, start, ray, leaf, counts);
}

/// Whether `leaf(primitive_id, ray)` was true for any primitive; stops at the first.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
bool any_hit(const View& view, const BoxRay& ray, Leaf&& leaf, Counts&& counts = {}) {
    auto start = scalar::make_root_key(typename View::Key{});
    return any_hit_from<kTraversal>(view, start, ray, leaf, counts);
}

} // namespace relief
