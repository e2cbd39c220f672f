// The patch tree cache: a ring buffer of growing addresses; trees further than its size behind the head are
// overwritten. Counterpart of cpu/patch_trees/patch_tree_cache.h; looked up by shaders/bottom_cache.comp.
#pragma once

#include <optional>

#include "vulkan/device/buffer.h"
#include "vulkan/device/commands.h"
#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan {

/// What the pool of a cache may take.
struct PoolLimits {
    std::optional<uint64_t> cap_bytes; ///< 0: trees live for one wave; none: choose_pool_growth() says
    uint64_t tree_bytes = 0;           ///< of the trees of all patches, as far as they are known
    uint32_t last_head = 1u << 31;     ///< after it addresses restart, trees are discarded
};

/// How a pool without a cap begins and grows.
struct PoolGrowth {
    uint64_t first_bytes = 0;
    uint64_t most_bytes = 0;   ///< not above first_bytes: it does not grow
    uint32_t rebuilds = 0;     ///< times its size that is built before it grows
    uint32_t budget_share = 0; ///< a wave may overwrite 1 / budget_share of it
};

/// For a device with what it has free now.
PoolGrowth choose_pool_growth(const Device& device, const PoolLimits& limits);

/// Not thread safe.
class PatchTreeCache {
  public:
    PatchTreeCache(const Device& device, const PoolLimits& limits)
        : PatchTreeCache(device, limits, choose_pool_growth(device, limits)) {}
    PatchTreeCache(const Device& device, const PoolLimits& limits, const PoolGrowth& growth);

    void bind(BindingTable& bindings) const;

    /// Call before the jobs of a chunk of rays are collected. May clear the records of all trees in `trees`:
    /// where addresses restart, and where the pool grows because trees were overwritten again and again.
    void begin_chunk(const Buffer& trees, Commands& commands, BindingTable& bindings);

    /// Fills in the push constants of a wave of jobs and records the commands that precede it.
    void begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands);
    /// Takes over `pool_head` after the wave.
    void end_wave(const scalar::CounterData& counters);

    uint64_t byte_count() const { return pool_.byte_count(); }

  private:
    void make_pool(uint64_t bytes);
    void grow(Commands& commands, BindingTable& bindings);
    uint32_t find_budget() const;

    const Device& device_;
    Buffer pool_;
    bool is_kept_;
    uint32_t last_head_;
    PoolGrowth growth_;
    uint64_t built_units_ = 0; ///< since the pool was made
    uint32_t capacity_ = 0;    ///< units
    uint32_t head_ = 0;        ///< next address, units
    uint32_t wave_ = 0;
};

} // namespace relief::vulkan
