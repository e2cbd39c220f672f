// Patch trees kept between rays, batches, samples and bounces, under a byte cap.
//
// Look-ups take no lock: they read a few slots of a fixed table. A miss takes memory, under a lock, builds
// privately and publishes by compare-and-swap; what the clock hand evicts is unlinked, and freed when no
// worker can hold it (epoch-based reclamation, Fraser 2004, section 5.2.3). Beyond the cap a tree lives in
// scratch memory for one visit. The image never depends on any of this.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "cpu/patch_trees/given_up_trees.h"
#include "cpu/patch_trees/patch_tree.h"
#include "cpu/patch_trees/tree_memory.h"
#include "cpu/patch_trees/tree_slot.h"
#include "relief/render.h"

namespace relief::cpu {

/// Counted per worker, summed for the statistics.
struct TraceCounters {
    uint64_t pairs_emitted = 0, pairs_with_hit = 0;
    uint64_t built = 0, reused = 0;
    uint64_t rebuilt = 0; ///< of `built`: had been built before and given up for want of room
    uint64_t built_at_level[kMaxLevel + 1] = {};
    uint64_t upper_nodes = 0, patch_nodes = 0, blocks = 0; ///< visited; see Statistics
    double bottom_build_s = 0;
    double sampled_bottom_s = 0; ///< in patches, of the batches that were timed patch by patch

    void add(const TraceCounters& other);
};

/// The batches of one kind of rays at one depth of their paths.
struct CastCounters {
    uint64_t batches = 0, rays = 0, pairs = 0;
    double bottom_build_s = 0, trace_s = 0;           ///< tracing: without building
    double sampled_trace_s = 0, sampled_bottom_s = 0; ///< of the batches that were timed patch by patch

    void add(const CastCounters& other);
};

/// What a worker found last, one place a hash of the key: most look-ups end here, without a look at the table
/// or the tree. An entry serves while the epoch in which it was made lasts: nothing was taken out since.
struct RecentTrees {
    static constexpr size_t kCount = 2048;
    struct Entry {
        TreeKey key;
        const CachedTree* tree = nullptr;
        uint64_t epoch = 0; ///< 0: empty
    };
    std::vector<Entry> entries = std::vector<Entry>(kCount);

    Entry& place(const TreeKey& key) {
        const uint32_t mixed = (key.patch + key.tile * 0x9e3779b1u + key.surface * 0x85ebca6bu) * 0xc2b2ae35u;
        return entries[((mixed ^ key.levels * 0x27d4eb2fu) >> 16) % kCount];
    }
};

/// What one worker needs while it traces a batch, between PatchTreeCache::acquire and release.
struct TraceContext {
    std::atomic<uint64_t> epoch{0}; ///< 0: holds no tree
    std::atomic<bool> is_taken{false};
    TraceContext* next = nullptr;

    struct Retired {
        CachedTree* tree;
        uint64_t epoch;
    };
    std::vector<Retired> retired;
    std::vector<void*> freed; ///< memory of free_older
    RecentTrees recent;
    bool owns_trees = false;        ///< see PatchTreeCache::OwnedTrees
    std::vector<CachedTree*> owned; ///< then, the trees
    struct AlignedFree {
        void operator()(void* memory) const;
    };
    std::unique_ptr<void, AlignedFree> tree_scratch;
    std::unique_ptr<void, AlignedFree> directory_scratch; ///< one of each step
    TraceCounters counters;
    bool is_timed = false;           ///< this batch measures its bottom stage
    std::vector<CastCounters> casts; ///< at 2 depth, shadow rays at 2 depth + 1
};

/// Bounds of trees, directories and table. The cap is doubled, up to `most_bytes` and half of the memory that
/// is available, when a quarter of it has been built again since it was last set.
struct CacheLimits {
    size_t cap_bytes = 0; ///< at first; 0: nothing is kept
    size_t most_bytes = 0;
    size_t patch_count = 0; ///< with a tree each: two slots a patch, within an eighth of `cap_bytes`
};

class PatchTreeCache {
  public:
    /// `build_tree` makes the trees.
    PatchTreeCache(CacheLimits limits, BuildTreeFunction build_tree);
    ~PatchTreeCache();
    PatchTreeCache(const PatchTreeCache&) = delete;
    PatchTreeCache& operator=(const PatchTreeCache&) = delete;

    TraceContext& acquire();
    void release(TraceContext& context);

    /// While this lives, a context builds and finds trees of its own alone, whatever their bytes: for a
    /// worker that needs those of one patch for many rays and then never again.
    class OwnedTrees {
      public:
        OwnedTrees(PatchTreeCache& cache, TraceContext& context);
        ~OwnedTrees();
        OwnedTrees(const OwnedTrees&) = delete;
        OwnedTrees& operator=(const OwnedTrees&) = delete;

      private:
        PatchTreeCache& cache_;
        TraceContext& context_;
    };

    /// Asked before every tree or directory that is made, by any worker: true makes look-ups throw
    /// StopRequest (base/stop_request.h). Empty: never. Not while a context is taken.
    void set_stop(std::function<bool()> is_asked_for) { is_stop_asked_for_ = std::move(is_asked_for); }

    /// Forgets the trees and directories that `is_stale` picks. Not while a context is taken.
    void remove(const std::function<bool(const TreeKey&)>& is_stale);

    /// To be called between rays: trees returned before may be freed afterwards.
    void refresh(TraceContext& context) const {
        // Looked at again after the store: what is taken out from here on stays until the next refresh, and
        // what was taken out before is not among the recent trees of this epoch.
        for (uint64_t now = epoch_.load(); context.epoch.load(std::memory_order_relaxed) != now;
             now = epoch_.load())
            context.epoch.store(now);
    }

    /// Trees stay valid until the context's next refresh, release, or (without room) its next call.
    const PatchTree& find_or_build_tree(TraceContext& context, const Surface& surface, const TreeKey& key) {
        return static_cast<const PatchTree&>(find_or_build(context, surface, key));
    }
    const TileDirectory& find_or_build_directory(TraceContext& context, const Surface& surface,
                                                 const TreeKey& key) {
        return static_cast<const TileDirectory&>(find_or_build(context, surface, key));
    }
    /// Bytes held now and at most so far, with what goes around trees and the table.
    size_t byte_count() const { return allocated_.load() + table_bytes(); }
    size_t peak_byte_count() const { return peak_.load() + table_bytes(); }
    size_t cap_byte_count() const { return cap_bytes_.load(); }
    /// Bytes that trees may take: the cap, and what it may grow by now.
    size_t find_room() const;
    TraceCounters sum_counters() const;
    std::vector<CastCounters> sum_casts() const;

  private:
    const CachedTree& find_or_build(TraceContext& context, const Surface& surface, const TreeKey& key) {
        const RecentTrees::Entry& recent = context.recent.place(key);
        if (recent.epoch != context.epoch.load(std::memory_order_relaxed) || !(recent.key == key))
            return find_or_build_elsewhere(context, surface, key);
        ++context.counters.reused;
        return *recent.tree;
    }
    const CachedTree& find_or_build_elsewhere(TraceContext& context, const Surface& surface,
                                              const TreeKey& key);
    PatchTree* make_tree(TraceContext& context, const Surface& surface, const TreeKey& key);
    TileDirectory* make_directory(TraceContext& context, const Surface& surface, const TreeKey& key);
    CachedTree* find(TraceContext& context, const TreeKey& key) const;
    void* allocate(TraceContext& context, size_t bytes);
    void offer(TraceContext& context, CachedTree* tree);
    void evict(TraceContext& context, size_t bytes);
    void retire(TraceContext& context, CachedTree* tree);
    void free_retired(TraceContext& context);
    void free_older(TraceContext& context, uint64_t epoch);
    void free_tree(CachedTree* tree);
    size_t unlink(TraceContext& context, uint32_t slot);
    /// Gives a block back whose tree could not be built.
    struct BlockGuard {
        PatchTreeCache& cache;
        void* memory; ///< null: there is none, or the tree is built
        size_t taken;
        bool is_owned;
        ~BlockGuard();
    };
    void note_rebuild(TraceContext& context, const CachedTree& tree);
    bool grow();
    void note_peak(size_t now);
    void own(TraceContext& context, CachedTree* tree) const;
    CachedTree* find_owned(TraceContext& context, const TreeKey& key) const;
    /// What an eviction makes room for, a little more than `bytes`, so that the next builds find some.
    size_t find_reserve(size_t bytes) const { return std::max(bytes, cap_bytes_.load() / 64); }
    size_t table_bytes() const { return slot_count_ * sizeof(std::atomic<TreeSlot>); }

    std::atomic<size_t> cap_bytes_;  ///< without the table
    std::atomic<size_t> most_bytes_; ///< likewise
    std::mutex grow_mutex_;
    TreeMemory memory_;
    GivenUpTrees given_up_;
    std::atomic<size_t> rebuilt_bytes_{0}; ///< since the cap was set
    BuildTreeFunction build_tree_;
    size_t slot_count_ = 0; ///< power of two, or 0
    std::unique_ptr<std::atomic<TreeSlot>[]> slots_;
    std::atomic<size_t> hand_{0}, allocated_{0}, peak_{0};
    std::atomic<size_t> retired_{0}; ///< bytes unlinked and not freed yet; part of allocated_
    mutable std::atomic<uint64_t> epoch_{1};
    std::function<bool()> is_stop_asked_for_;
    std::atomic<TraceContext*> contexts_{nullptr};
};

} // namespace relief::cpu
