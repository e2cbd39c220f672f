// The one walk through what a patch keeps (patch_tree.h), for one ray, a packet or a bundle.
#pragma once

#include <concepts>
#include <optional>

#include "base/timer.h"
#include "cpu/patch_trees/patch_tree_build-inl.h"
#include "cpu/traversal/entry_list-inl.h"
#include "cpu/traversal/kernels.h"
#include "formulas/levels.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// A patch at the levels that a ray or a group of rays sees.
struct PatchVisit {
    const cpu::SceneView* scene;
    cpu::TraceContext* context;
    uint32_t surface, patch;
    uint32_t levels; ///< pack_levels

    RELIEF_INLINE PatchVisit(const cpu::SceneView& of, cpu::TraceContext& with, uint32_t instance,
                             uint32_t of_patch, uint32_t lod_bias)
        : scene(&of), context(&with), surface(of.instances[instance].surface), patch(of_patch) {
        levels = of.instances[instance].levels->packed_at(patch);
        if (lod_bias != 0) levels = scalar::lower_packed_levels(levels, lod_bias);
    }
    RELIEF_INLINE uint32_t level() const { return scalar::packed_patch_level(levels); }
    /// In (u, v).
    RELIEF_INLINE float cell_size() const { return 1.0f / float(1u << level()); }

    RELIEF_INLINE const cpu::PatchTree& find_tree(uint32_t tile) const {
        return scene->cache->find_or_build_tree(*context, scene->surfaces[surface],
                                                {surface, patch, tile, levels});
    }
    RELIEF_INLINE const cpu::TileDirectory& find_directory(const cpu::DirectoryPlace& place) const {
        return scene->cache->find_or_build_directory(*context, scene->surfaces[surface],
                                                     {surface, patch, place.number(), levels});
    }
    RELIEF_INLINE void count_node() const { ++context->counters.patch_nodes; }
    RELIEF_INLINE void count_pairs(uint32_t entered, uint32_t hit) const {
        context->counters.pairs_emitted += entered, context->counters.pairs_with_hit += hit;
    }
};

/// What goes through a patch. Which of its rays enter a box is a mask: the lanes of a packet, else 1.
template <class Probe>
concept PatchProbe = requires(Probe& probe, const cpu::PatchTree& tree, uint32_t block, LaneMask rays,
                              const float (&boxes8)[6][8], const float (&boxes16)[6][16],
                              bool (&visit)(uint32_t child, LaneMask rays)) {
    { probe.visit } -> std::convertible_to<const PatchVisit&>;
    /// Whether single boxes are cheap beside blocks, so that leaves are listed before the first block.
    { Probe::kListsLeaves } -> std::convertible_to<bool>;
    /// Calls visit(child, rays) for the boxes that are entered, nearest first, until it is true.
    { probe.visit_children(boxes8, rays, visit) } -> std::same_as<bool>;
    { probe.visit_children(boxes16, rays, visit) } -> std::same_as<bool>;
    /// Sixteen triangles. True where nothing more is asked.
    { probe.test_block(tree, 6, block, rays) } -> std::same_as<bool>;
    /// Counts the rays of a visit and those with a hit.
    probe.count_pairs(rays);
};

/// The boxes of a tree, a step or two.
template <int kLevel, PatchProbe Probe>
RELIEF_INLINE bool visit_nodes(const cpu::PatchTree& tree, Probe& probe, LaneMask rays) {
    using Shape = cpu::TreeShape<kLevel>;
    const auto visit_leaf = [&](uint32_t leaf, LaneMask entered) __attribute__((always_inline)) {
        for (uint32_t block = leaf * Shape::kLeafBlocks; block < (leaf + 1) * Shape::kLeafBlocks; ++block)
            if (probe.test_block(tree, kLevel, block, entered)) return true;
        return false;
    };
    probe.visit.count_node();
    if constexpr (!Shape::kHasGroups) {
        return probe.visit_children(tree.node<kLevel>(0).bounds, rays, visit_leaf);
    } else if constexpr (Probe::kListsLeaves) {
        // Boxes of all groups before the first block: their loads overlap, and one list is sorted.
        EntryList<16 * Shape::kWidth> leaves;
        probe.visit_any_order(tree.root().bounds, [&](uint32_t group) {
            probe.visit.count_node();
            probe.list_children(tree.node<kLevel>(group).bounds, group * Shape::kWidth, leaves);
        });
        return probe.visit_listed(leaves, visit_leaf);
    } else {
        return probe.visit_children(tree.root().bounds, rays, [&](uint32_t group, LaneMask entered) {
            probe.visit.count_node();
            const auto visit = [&](uint32_t k, LaneMask left) {
                return visit_leaf(group * Shape::kWidth + k, left);
            };
            return probe.visit_children(tree.node<kLevel>(group).bounds, entered, visit);
        });
    }
}

/// Everything of a tile; true where nothing more is asked.
template <PatchProbe Probe> bool visit_patch_tree(const cpu::PatchTree& tree, Probe& probe, LaneMask rays) {
    if (tree.level == 6) return visit_nodes<6>(tree, probe, rays);
    if (tree.level == 5) return visit_nodes<5>(tree, probe, rays);
    if (tree.level == 4) return visit_nodes<4>(tree, probe, rays);
    if (tree.level == 3) return visit_nodes<3>(tree, probe, rays);
    for (uint32_t block = 0; block < cpu::PatchTree::block_count(int(tree.level)); ++block)
        if (probe.test_block(tree, int(tree.level), block, rays)) return true;
    return false;
}

/// A directory and all below. Nearest first also for any-hit, for the cache's sake.
template <PatchProbe Probe>
bool visit_directory(const cpu::DirectoryPlace& place, Probe& probe, LaneMask rays) {
    const cpu::TileDirectory& directory = probe.visit.find_directory(place);
    const uint32_t level = probe.visit.level();
    LaneMask visited[4] = {}; // of each tile: by which rays
    probe.visit.count_node();
    const auto visit = [&](uint32_t number, LaneMask entered) {
        const cpu::DirectoryPlace child = place.child(level, number);
        if (!place.is_last(level)) return visit_directory(child, probe, entered);
        LaneMask& before = visited[cpu::TileDirectory::find_tile_of_node(number)];
        const LaneMask left = entered & ~before;
        before |= left;
        if (left == 0) return false;
        return visit_patch_tree(probe.visit.find_tree(child.tile(level)), probe, left);
    };
    return probe.visit_children(directory.node.bounds, rays, visit);
}

/// The time of a patch where the batch is timed: all but that of building.
class PatchClock {
  public:
    RELIEF_INLINE explicit PatchClock(cpu::TraceContext& context) : counters_(context.counters) {
        if (!context.is_timed) return;
        timer_.emplace();
        built_before_ = counters_.bottom_build_s;
    }
    RELIEF_INLINE ~PatchClock() {
        if (timer_)
            counters_.sampled_bottom_s += timer_->seconds() - (counters_.bottom_build_s - built_before_);
    }
    PatchClock(const PatchClock&) = delete;
    PatchClock& operator=(const PatchClock&) = delete;

  private:
    cpu::TraceCounters& counters_;
    std::optional<Timer> timer_;
    double built_before_ = 0;
};

/// Everything of a patch.
template <PatchProbe Probe> RELIEF_INLINE void visit_patch(Probe& probe, LaneMask rays) {
    const PatchClock clock(*probe.visit.context);
    if (probe.visit.level() <= cpu::kTileLevel)
        visit_patch_tree(probe.visit.find_tree(0), probe, rays);
    else
        visit_directory(cpu::DirectoryPlace{}, probe, rays);
    probe.count_pairs(rays);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
