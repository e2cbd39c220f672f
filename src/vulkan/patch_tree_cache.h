// The patch tree cache: a ring buffer of growing addresses; trees further than its size behind the head are
// overwritten. Counterpart of cpu/patch_trees/patch_tree_cache.h; looked up by shaders/bottom_cache.comp.
#pragma once

#include "vulkan/device/buffer.h"
#include "vulkan/device/commands.h"
#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan {

/// Not thread safe.
class PatchTreeCache {
  public:
    /// `cap_bytes` 0: trees live for one wave. `last_head`: after it addresses restart, trees are discarded.
    PatchTreeCache(const Device& device, uint64_t cap_bytes, uint32_t last_head);

    void bind(BindingTable& bindings) const;

    /// Call before the jobs of a chunk of rays are collected. May clear the records of all trees in `trees`.
    void begin_chunk(const Buffer& trees, Commands& commands);

    /// Fills in the push constants of a wave of jobs and records the commands that precede it.
    void begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands);
    /// Takes over `pool_head` after the wave.
    void end_wave(const scalar::CounterData& counters);

  private:
    Buffer pool_;
    bool is_kept_;
    uint32_t last_head_;
    uint32_t capacity_; ///< units
    uint32_t head_ = 0; ///< next address, units
    uint32_t wave_ = 0;
};

} // namespace relief::vulkan
