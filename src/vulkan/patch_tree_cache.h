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
    std::optional<uint64_t> cap_bytes; ///< 0: trees live for one wave; none: as much as a device can spare
    uint64_t tree_bytes = 0;           ///< of the trees of all patches, as far as they are known
    uint32_t last_head = 1u << 31;     ///< after it addresses restart, trees are discarded
};

/// Not thread safe.
class PatchTreeCache {
  public:
    PatchTreeCache(const Device& device, const PoolLimits& limits);

    void bind(BindingTable& bindings) const;

    /// Call before the jobs of a chunk of rays are collected. May clear the records of all trees in `trees`:
    /// where addresses restart, and where the pool grows because trees were overwritten again and again.
    void begin_chunk(const Buffer& trees, Commands& commands, BindingTable& bindings);

    /// Fills in the push constants of a wave of jobs and records the commands that precede it.
    void begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands);
    /// Takes over `pool_head` after the wave.
    void end_wave(const scalar::CounterData& counters);

  private:
    void make_pool(uint64_t bytes);
    void grow(Commands& commands, BindingTable& bindings);
    uint32_t find_budget() const;

    const Device& device_;
    Buffer pool_;
    bool is_kept_;
    uint32_t last_head_;
    uint64_t most_bytes_ = 0;  ///< that the pool may grow to
    uint64_t built_units_ = 0; ///< since the pool was made
    uint32_t capacity_ = 0;    ///< units
    uint32_t head_ = 0;        ///< next address, units
    uint32_t wave_ = 0;
};

} // namespace relief::vulkan
