// Single rays through the trees over instances and patches by a traversal chosen by name: the loops of
// lab/walks/traverse_*.h, which the kernels of a device run too. Not tuned as the wide trees are.
#include "lab/scene_walks.h"

#include <array>
#include <cmath>
#include <iterator>
#include <tuple>

#include "base/check.h"
#include "engine/finite_ray.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/walk_trees.h"
#include "lab/walks/trail.h"
#include "prepare/traversals.h"

namespace relief {

namespace scalar {

namespace {

using cpu::PrimitiveKernels;
using cpu::SceneView;
using cpu::TraceContext;
using cpu::TraceHit;
using cpu::TraceRay;

/// What a walk reads.
struct WalkScene {
    const SceneView& scene;
    const WalkTrees& trees;
    const PrimitiveKernels& primitive;
};

/// Primitives of a kd-tree that a ray was last tested against: neighbouring leaves share them.
class Mailbox {
  public:
    void clear() { ids_.fill(kNoIndex); }

    /// False: it is among them.
    bool add(uint32_t id) {
        uint32_t& place = ids_[id % ids_.size()];
        const bool is_new = place != id;
        place = id;
        return is_new;
    }

  private:
    std::array<uint32_t, 64> ids_;
};

/// One ray. A leaf of the tree of instances replaces the walk by that of a surface; resume_walk() brings the
/// old walk back, or the leaf's next instance. `Width`: uint or HeapKey, for trees of 30 or 62 levels.
template <TraversalKind kTraversal, class Width> class RayWalk {
  public:
    using Key = Width;

    /// `visit`: one of view.primitive.
    RayWalk(const WalkScene& view, TraceContext& context, const TraceRay& world,
            PrimitiveKernels::Function visit)
        : view_(view),
          context_(context),
          world_(world),
          visit_(visit),
          is_any_(visit == view.primitive.any),
          limit_(world.t_max),
          world_ray_(make_object_ray(world.origin, world.direction)) {}

    /// True: a primitive ended the walk, which only those of any_hits do.
    bool run(TraceHit& best) {
        best_ = &best;
        if constexpr (kIsKd) instances_.clear();
        leave_instance();
        stack_walk = make_empty_stack();
        start();
        const bool is_complete = run_walk();
        DCHECK(is_complete);
        static_cast<void>(is_complete);
        return is_ended_;
    }

  private:
#include "lab/walks/walk_members-inl.h"

    void leave_instance() {
        instance_ = kNoIndex;
        tree_ = &view_.trees.instances;
        ray_ = world_ray_;
    }

    void enter_instance(uint32_t index) {
        const Instance& instance = view_.scene.instances[index];
        instance_ = index;
        tree_ = &view_.trees.surfaces[instance.surface];
        const LocalStart local =
            find_local_start(world_.origin, world_.direction, instance.object_space.origin,
                             instance.world_from_object.translation, instance.reach);
        const Affine& from_origin = instance.object_space.from_origin;
        ray_ = make_object_ray(transform_point(from_origin, local.origin),
                               transform_vector(from_origin, world_.direction));
        ray_.shift = local.shift;
        if constexpr (kIsKd) patches_.clear();
        start();
    }

    /// Walks the current tree from its root.
    void start() {
        const bool is_empty = tree_->bounds.is_empty();
        start_walk(is_empty ? kNoNode : 0u, make_key(is_empty ? 0u : 1u));
    }

    static Key make_key(uint low) {
        if constexpr (kIsWide)
            return {low, 0u};
        else
            return low;
    }

    KdRay make_own_kd_ray() const {
        const Box& cell = tree_->kd.bounds;
        return make_kd_ray(ray_, cell.lower, cell.upper, world_.t_min, limit_);
    }

    /// In the order of TraversalKind.
    static constexpr size_t kIndex = size_t(kTraversal) - size_t(TraversalKind::stack);
    using State =
        std::tuple_element_t<kIndex, std::tuple<StackState, RestartState, ParentLinkState, SkipLinkState,
                                                TrailState, PairTrailState, KdState, KdState, KdState>>;

    State& state() {
        return std::get<kIndex>(std::tie(stack_walk, restart_walk, parent_walk, skip_walk, trail_walk,
                                         pair_walk, kd_walk, kd_walk, kd_walk));
    }

    /// The ids that leaves of the current tree count into.
    const std::vector<uint32_t>& primitive_ids() const {
        if (!tree_->kd.nodes.empty()) return tree_->kd.primitive_ids;
        return tree_->heap.nodes.empty() ? tree_->linked.primitive_ids : tree_->heap.primitive_ids;
    }

    // The hooks of formulas/tree.h.
    TreeNode load_node(uint node) const {
        if constexpr (kTraversal == TraversalKind::trail || kTraversal == TraversalKind::pair_trail)
            return tree_->heap.nodes[node];
        else
            return tree_->linked.nodes[node];
    }
    uint load_parent(uint node) const { return tree_->linked.parents[node]; }
    uint load_skip(uint node) const { return tree_->linked.skips[node]; }
    HeapForm get_heap_form() const { return tree_->heap.form; }
    HeapBlock load_heap_block(uint block) const { return tree_->heap.blocks[block]; }
    HeapBrick load_heap_brick(uint brick) const { return tree_->heap.bricks[brick]; }
    uint find_slot(Key key) { return find_succinct_slot(key); }
    KdNode load_kd_node(uint node) const { return tree_->kd.nodes[node]; }
    KdBox load_kd_box(uint node) const { return tree_->kd.cells[node]; }
    float get_limit() const { return limit_; }
    float enter_box(const TreeNode& node) const { return cross_node(ray_, node, world_.t_min, limit_); }
    float enter_whole_box(const TreeNode& node) const {
        return cross_node(ray_, node, world_.t_min, world_.t_max);
    }
    bool is_axis_backward(uint axis) const { return select_axis(ray_.direction, axis) < 0.0f; }
    void count_box_test() {}
    void count_restart() {}
    void count_bytes(uint) {}

    /// Of a leaf's primitive: other leaves' boxes were met on the way; a kd leaf's hold more than it has.
    bool is_to_be_entered(uint32_t id, Mailbox& mailbox) {
        if constexpr (kIsKd) {
            const Box& box = tree_->boxes[id];
            return mailbox.add(id) && is_box_met(cross_box(ray_, box.lower, box.upper, world_.t_min, limit_));
        } else {
            return true;
        }
    }

    /// `word` of a kd leaf is its count.
    bool visit_leaf(uint first, uint word, uint) {
        const uint count = get_word_count(word);
        if (instance_ == kNoIndex) {
            waiting_first_ = first, waiting_count_ = count;
            world_state_ = state();
            enter_next_instance();
            return false;
        }
        for (uint k = 0; k < count; ++k) {
            const uint32_t patch = primitive_ids()[first + k];
            if (!is_to_be_entered(patch, patches_)) continue;
            const bool is_hit = visit_(view_.scene, context_, world_, instance_, patch, *best_);
            limit_ = std::fmin(world_.t_max, best_->t);
            if (is_hit && is_any_) return is_ended_ = true;
        }
        return false;
    }

    /// In world space. False: none is left.
    bool enter_next_instance() {
        while (waiting_count_ > 0) {
            const uint32_t index = primitive_ids()[waiting_first_];
            ++waiting_first_, --waiting_count_;
            if (!view_.scene.is_visible(index)) continue;
            if (!is_to_be_entered(index, instances_)) continue;
            enter_instance(index);
            return true;
        }
        return false;
    }

    bool resume_walk() {
        if (instance_ == kNoIndex) return false;
        leave_instance();
        if (enter_next_instance()) return true;
        state() = world_state_;
        if constexpr (kTraversal == TraversalKind::restart_trail) state() = drop_short_stack(state());
        return true;
    }

    const WalkScene& view_;
    TraceContext& context_;
    const TraceRay& world_;
    const PrimitiveKernels::Function visit_;
    const bool is_any_;
    float limit_; ///< no hit beyond it is of interest
    TraceHit* best_ = nullptr;
    bool is_ended_ = false;
    uint32_t instance_ = kNoIndex; ///< kNoIndex: in the tree of instances
    const WalkTree* tree_ = nullptr;
    const ObjectRay world_ray_;
    ObjectRay ray_{};
    Mailbox instances_, patches_; ///< of the kd-tree of instances, and of that of the current instance
    uint waiting_first_ = 0, waiting_count_ = 0; ///< instances of the leaf still to be entered
    State world_state_{};                        ///< of the tree of instances, past that leaf
};

/// `Width`: as of RayWalk.
template <TraversalKind kTraversal, class Width = uint> class NamedWalk final : public cpu::SceneWalk {
  public:
    explicit NamedWalk(WalkTrees trees) : trees_(std::move(trees)) {}

    void closest_hits(const SceneView& scene, const PrimitiveKernels& primitive, TraceContext& context,
                      const TraceRay* rays, TraceHit* hits, size_t count) const override {
        const WalkScene view{scene, trees_, primitive};
        for (size_t k = 0; k < count; ++k) {
            hits[k] = {};
            trace(view, context, k, rays[k], primitive.closest, hits[k]);
            hits[k].lod_bias = uint8_t(rays[k].lod_bias);
        }
    }

    void any_hits(const SceneView& scene, const PrimitiveKernels& primitive, TraceContext& context,
                  const TraceRay* rays, uint8_t* occluded, size_t count) const override {
        const WalkScene view{scene, trees_, primitive};
        for (size_t k = 0; k < count; ++k) {
            TraceHit best;
            occluded[k] = trace(view, context, k, rays[k], primitive.any, best);
        }
    }

    size_t byte_count() const override { return trees_.byte_count(); }

  private:
    /// Ray `k` of a batch.
    static bool trace(const WalkScene& view, TraceContext& context, size_t k, const TraceRay& ray,
                      PrimitiveKernels::Function visit, TraceHit& best) {
        if (k % 16 == 0) view.scene.cache->refresh(context);
        return can_hit(ray) && RayWalk<kTraversal, Width>(view, context, ray, visit).run(best);
    }

    const WalkTrees trees_;
};

using WalkPointer = std::unique_ptr<const cpu::SceneWalk>;

template <TraversalKind kTraversal> WalkPointer make_walk(WalkTrees trees) {
    return std::make_unique<NamedWalk<kTraversal>>(std::move(trees));
}

/// Of a walk with a key or a trail, as wide as the trees are deep.
template <TraversalKind kTraversal> WalkPointer make_trail_walk(WalkTrees trees) {
    if (trees.depth <= int(kTrailLevels32)) return make_walk<kTraversal>(std::move(trees));
    return std::make_unique<NamedWalk<kTraversal, HeapKey>>(std::move(trees));
}

/// In the order of TraversalKind, from stack on.
constexpr WalkPointer (*kMakers[])(WalkTrees) = {
    make_walk<TraversalKind::stack>,       make_trail_walk<TraversalKind::restart_trail>,
    make_walk<TraversalKind::parent_link>, make_walk<TraversalKind::skip_link>,
    make_trail_walk<TraversalKind::trail>, make_trail_walk<TraversalKind::pair_trail>,
    make_walk<TraversalKind::restart>,     make_walk<TraversalKind::push_down>,
    make_walk<TraversalKind::backtrack>};
static_assert(std::size(kMakers) == kTraversalCount - size_t(TraversalKind::stack));

} // namespace

} // namespace scalar

std::unique_ptr<const cpu::SceneWalk> make_scene_walk(const PreparedScene& scene,
                                                      const RenderSettings& settings) {
    if (is_default_traversal(settings, EngineKind::cpu)) return nullptr;
    WalkTrees trees = make_walk_trees(scene, settings, EngineKind::cpu);
    const size_t maker = size_t(trees.traversal) - size_t(TraversalKind::stack);
    return scalar::kMakers[maker](std::move(trees));
}

} // namespace relief
