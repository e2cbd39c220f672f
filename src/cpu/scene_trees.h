// The two scene trees as rays of the CPU engine walk them. They are made twice: soon, from the bounds of
// maps, and again, from the vertices, when so many rays have come that smaller boxes are worth it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "bvh/wide_bvh.h"
#include "cpu/patch_trees/patch_boxes.h"
#include "engine/engine.h"

namespace relief::cpu {

struct SceneTrees {
    BoxSource source = BoxSource::bounds; ///< of the boxes of displaced patches
    std::vector<WideBvh> surfaces;        ///< one a surface, over its patches; empty without displacement
    std::vector<double> areas;            ///< of their nodes, when each was built
    WideBvh instances;
    std::vector<std::shared_ptr<const LevelField>> levels; ///< of the instances, that vertices are at

    size_t byte_count() const;
};

class SceneTreeHolder {
  public:
    /// All of what is given outlives this. `polygon_trees`: one a surface, empty with displacement.
    SceneTreeHolder(const PreparedScene& scene, const Kernels& kernels,
                    std::span<const PolygonTree> polygon_trees);

    /// To be walked while the result lives. Thread safe.
    std::shared_ptr<const SceneTrees> current() const;

    /// After rays have been traced. Thread safe.
    void count_rays(size_t rays) { rays_to_come_.fetch_sub(int64_t(rays), std::memory_order_relaxed); }

    /// Rebuilds the trees once if that pays; between batches, to be deterministic. Thread safe.
    void rebuild_if_worthwhile();

    /// As Engine::apply_changes: not while rays are traced. Adds boxes of what changed, world space.
    void apply_changes(std::span<const SurfaceChange> changes, std::vector<Box>& places);

    /// The levels of instances may have changed: trees of vertices at other ones are given up for those of
    /// the bounds of maps, which hold all levels. Not while rays are traced.
    void follow_levels();

    /// As Engine::change_scene: not while rays are traced. Trees of surfaces that have changed as a whole are
    /// refitted, and built anew once their area has grown by half.
    void change_scene(std::span<const SurfaceChange> changes);

  private:
    void start();
    bool is_mostly_changed(std::span<const SurfaceChange> changes) const;
    WideBvh make_surface_tree(uint32_t surface, const PatchBoxes& boxes) const;
    std::shared_ptr<SceneTrees> make_trees(BoxSource source) const;
    WideBvh make_instance_tree(std::span<const WideBvh> surfaces) const;
    void add_places(const SurfaceChange& change, const WideBvh& tree, std::vector<Box>& places) const;

    const PreparedScene& scene_;
    const Kernels& kernels_;
    std::span<const PolygonTree> polygon_trees_;
    std::atomic<int64_t> rays_to_come_{0}; ///< until it pays; 0 or less: it does
    std::atomic<bool> is_improved_{false}; ///< or there is nothing to be made smaller
    mutable std::mutex mutex_;             ///< of the pointer
    std::shared_ptr<SceneTrees> trees_;
};

} // namespace relief::cpu
