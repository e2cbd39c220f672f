// The walks of lab/walks/traverse_*.h over one tree alone, of lab/trees/ or with links: for `relief bench
// paper2`, and the reference for kernels. Scenes have walks of their own: lab/cpu/scene_walks.cpp.
//   closest_hit_from<TraversalKind::trail>(make_walk_view(heap), start, ray, leaf);
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "base/check.h"
#include "bvh/tree_links.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/trees/heap_tree.h"
#include "lab/trees/sah_kdtree.h"
#include "lab/walks/trail.h"
#include "math/box.h"
#include "relief/traversal.h"

namespace relief {

/// Direction of any length but zero; t counts in its lengths. 0 <= t_min.
struct BoxRay {
    Vec3f origin{};
    Vec3f direction{};
    float t_min = 0;
    float t_max = std::numeric_limits<float>::infinity();
};

/// What a walk did; added up over rays.
struct WalkCounts {
    uint64_t box_tests = 0;
    uint64_t primitive_tests = 0;
    uint64_t restarts = 0;
    uint64_t bytes = 0; ///< of nodes, links and directories; not of primitives
};

/// Without counting.
struct NoCounts {};

namespace scalar {

/// A tree and the width of its keys and trails: uint or HeapKey, for trees of 30 or 62 levels.
template <class Tree, class Width = uint> struct WalkView {
    using Key = Width;
    const Tree& tree;
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
        if (view_.tree.nodes.empty()) return false;
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
    TreeNode load_node(uint node) const { return view_.tree.nodes[node]; }
    uint load_parent(uint node) const { return view_.tree.parents[node]; }
    uint load_skip(uint node) const { return view_.tree.skips[node]; }
    HeapForm get_heap_form() const { return view_.tree.form; }
    HeapBlock load_heap_block(uint block) const { return view_.tree.blocks[block]; }
    HeapBrick load_heap_brick(uint brick) const { return view_.tree.bricks[brick]; }
    KdNode load_kd_node(uint node) const { return view_.tree.nodes[node]; }
    KdBox load_kd_box(uint node) const { return view_.tree.cells[node]; }

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
            is_ended_ = leaf_(view_.tree.primitive_ids[first + k], ray_);
        }
        if (is_ended_ || ray_.t_max < limit) {
            if constexpr (kTraversal == TraversalKind::trail) hit_leaf_ = trail_walk.leaf;
            if constexpr (kTraversal == TraversalKind::pair_trail) hit_leaf_ = pair_walk.leaf;
        }
        return is_ended_;
    }

    uint find_slot(Key key) {
        if constexpr (requires { view_.tree.form; })
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

} // namespace scalar

template <class Tree> scalar::WalkView<Tree> make_walk_view(const Tree& tree) { return {tree}; }

/// For trees of more than kTrailLevels32 levels.
template <class Tree> scalar::WalkView<Tree, scalar::HeapKey> make_wide_walk_view(const Tree& tree) {
    return {tree};
}

/// Calls `leaf(primitive_id, ray)` for primitives whose box the ray may meet before ray.t_max (in kd-trees
/// perhaps again); the leaf shortens ray.t_max and decides ties. Trails start at node `start`, which becomes
/// the leaf of the hit; others at the root. `counts`: WalkCounts to add to, or NoCounts.
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

/// Whether `leaf(primitive_id, ray)` was true for any primitive; stops at the first. Otherwise likewise.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
bool any_hit_from(const View& view, typename View::Key& start, BoxRay ray, Leaf&& leaf,
                  Counts&& counts = {}) {
    scalar::Walker<kTraversal, View, std::remove_reference_t<Leaf>, std::remove_reference_t<Counts>> walker(
        view, ray, leaf, counts);
    const bool is_hit = walker.run(start);
    start = walker.hit_leaf();
    return is_hit;
}

} // namespace relief
