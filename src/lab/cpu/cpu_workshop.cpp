// Trees over one mesh on the processor: the scalar walks of lab/walks/walks.h, rays over threads.
#include "lab/tree_workshop.h"

#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "formulas/object_ray.h"
#include "lab/walks/trail.h"
#include "lab/walks/walks.h"
#include "relief/error.h"
#include "relief/traversal.h"

namespace relief::cpu {

namespace {

constexpr size_t kRaysOfAJob = 512;

scalar::HeapKey split_key(uint64_t key, scalar::HeapKey) { return {uint32_t(key), uint32_t(key >> 32)}; }
uint32_t split_key(uint64_t key, uint32_t) { return uint32_t(key); }
uint64_t join_key(scalar::HeapKey key) { return key.low | uint64_t(key.high) << 32; }
uint64_t join_key(uint32_t key) { return key; }

/// Tests the triangles of one ray: as leaf of a walk.
class TriangleLeaf {
  public:
    TriangleLeaf(const TriangleSoup& soup, const BoxRay& ray)
        : soup_(soup), ray_(scalar::make_object_ray(ray.origin, ray.direction)) {}

    /// Nearest hit, ties to the lowest triangle.
    void offer(uint32_t triangle, BoxRay& ray) {
        const float t = intersect(triangle, ray);
        if (t == std::numeric_limits<float>::infinity() || t > best_.t) return;
        if (t == best_.t && triangle > best_.primitive) return;
        best_ = {t, triangle};
        ray.t_max = t;
    }

    bool stop_at(uint32_t triangle, const BoxRay& ray) {
        const float t = intersect(triangle, ray);
        if (t == std::numeric_limits<float>::infinity()) return false;
        best_ = {t, triangle};
        return true;
    }

    const TreeHit& best() const { return best_; }

  private:
    float intersect(uint32_t triangle, const BoxRay& ray) const {
        const uint32_t* corners = &soup_.indices[3 * size_t(triangle)];
        const auto shear = [&](int k) { return scalar::shear_vertex(ray_, soup_.positions[corners[k]]); };
        return scalar::intersect_sheared(ray_, shear(0), shear(1), shear(2), ray.t_min, ray.t_max).t;
    }

    const TriangleSoup& soup_;
    const scalar::ObjectRay ray_;
    TreeHit best_;
};

/// One cast over one form of tree.
template <TraversalKind kTraversal, class View> class Caster {
  public:
    Caster(const TriangleSoup& soup, const View& view, const TreeQuery& query, const TreeCastData& data)
        : soup_(soup), view_(view), query_(query), data_(data) {}

    TreeCast run() {
        const Timer timer;
        parallel_for("tree_cast", data_.rays.size(), kRaysOfAJob, [this](size_t begin, size_t end) {
            if (query_.counting == Counting::on) {
                WalkCounts counts;
                for (size_t k = begin; k < end; ++k) cast_ray(k, counts);
                add(counts);
            } else {
                NoCounts none;
                for (size_t k = begin; k < end; ++k) cast_ray(k, none);
            }
        });
        return {timer.seconds(), sums_.box_tests, sums_.primitive_tests, sums_.restarts, sums_.bytes};
    }

  private:
    template <class Counts> void cast_ray(size_t k, Counts& counts) {
        const Ray& given = data_.rays[k];
        BoxRay ray{given.origin, given.direction, given.t_min, given.t_max};
        auto start = split_key(data_.keys.empty() ? kRootKey : data_.keys[k], typename View::Key{});
        TriangleLeaf leaf(soup_, ray);
        if (query_.kind == HitKind::closest)
            closest_hit_from<kTraversal>(
                view_, start, ray, [&](uint32_t id, BoxRay& r) { leaf.offer(id, r); }, counts);
        else
            any_hit_from<kTraversal>(
                view_, start, ray, [&](uint32_t id, const BoxRay& r) { return leaf.stop_at(id, r); }, counts);
        data_.hits[k] = leaf.best();
        if (!data_.keys.empty()) data_.keys[k] = join_key(start);
    }

    void add(const WalkCounts& counts) {
        const std::lock_guard lock(mutex_);
        sums_.box_tests += counts.box_tests, sums_.primitive_tests += counts.primitive_tests;
        sums_.restarts += counts.restarts, sums_.bytes += counts.bytes;
    }

    const TriangleSoup& soup_;
    const View view_;
    const TreeQuery& query_;
    const TreeCastData& data_;
    std::mutex mutex_;
    WalkCounts sums_;
};

/// The walks over one form of tree, chosen by the query.
class Walks {
  public:
    Walks(const TriangleSoup& soup, const TreeQuery& query, const TreeCastData& data)
        : soup_(soup), query_(query), data_(data) {}

    TreeCast operator()(const LinkedBvh& tree) const {
        if (tree.depth > int(scalar::kTrailLevels32) && query_.traversal == TraversalKind::restart_trail)
            return run<TraversalKind::restart_trail>(make_wide_walk_view(tree));
        return run<TraversalKind::stack, TraversalKind::restart_trail, TraversalKind::parent_link,
                   TraversalKind::skip_link>(make_walk_view(tree));
    }

    TreeCast operator()(const DenseHeap& tree) const { return run_trail(make_walk_view(tree)); }

    TreeCast operator()(const SuccinctHeap& tree) const {
        return tree.depth <= int(scalar::kTrailLevels32) ? run_trail(make_walk_view(tree))
                                                         : run_trail(make_wide_walk_view(tree));
    }

    TreeCast operator()(const KdTree& tree) const {
        return run<TraversalKind::restart, TraversalKind::push_down, TraversalKind::backtrack>(
            make_walk_view(tree));
    }

  private:
    /// The one of these that the query names. Another one in its place would be measured under its name.
    template <TraversalKind kFirst, TraversalKind... kOthers, class View>
    TreeCast run(const View& view) const {
        if (query_.traversal == kFirst) return Caster<kFirst, View>(soup_, view, query_, data_).run();
        if constexpr (sizeof...(kOthers) > 0)
            return run<kOthers...>(view);
        else
            throw Error(ErrorKind::usage,
                        {fmt::format("there is no walk {} of this tree", traversal_name(query_.traversal)),
                         "trees over a mesh", ""});
    }
    template <class View> TreeCast run_trail(const View& view) const {
        return run<TraversalKind::pair_trail, TraversalKind::trail>(view);
    }

    const TriangleSoup& soup_;
    const TreeQuery& query_;
    const TreeCastData& data_;
};

class CpuTreeWorkshop final : public TreeWorkshop {
  public:
    explicit CpuTreeWorkshop(TriangleSoup soup)
        : TreeWorkshop(std::move(soup)), boxes_(compute_triangle_boxes(soup_)) {
        device_name_ = processor_name();
    }

    TreeBuild build(TreeKind kind, int heap_levels) override {
        tree_ = {}; // makes room
        BuiltTree built = build_host_tree(boxes_, kind, heap_levels);
        tree_ = std::move(built.tree);
        return built.report;
    }

    TreeCast cast(const TreeQuery& query, const TreeCastData& data) override {
        return std::visit(Walks(soup_, query, data), tree_);
    }

    bool contains_key(uint64_t key) const override {
        if (const auto* heap = std::get_if<DenseHeap>(&tree_)) return relief::contains_key(*heap, key);
        const auto* heap = std::get_if<SuccinctHeap>(&tree_);
        return heap && relief::contains_key(*heap, key);
    }

  private:
    std::vector<Box> boxes_;
    HostTree tree_;
};

} // namespace

} // namespace relief::cpu

namespace relief {

std::unique_ptr<TreeWorkshop> make_cpu_tree_workshop(TriangleSoup soup) {
    return std::make_unique<cpu::CpuTreeWorkshop>(std::move(soup));
}

} // namespace relief
