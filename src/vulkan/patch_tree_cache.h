// The pool of patch trees: a ring that is filled on and on. Places are numbered for ever; what lies more
// than the pool's size behind is gone. The counterpart of cpu/patch_trees/patch_tree_cache.h; its look-up is
// shaders/bottom_cache.comp.
#pragma once

#include "vulkan/device/buffer.h"
#include "vulkan/device/commands.h"
#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan {

/// One thread at a time.
class PatchTreeCache {
  public:
    /// `cap_bytes` 0: trees serve one wave of jobs only, and the pool is working memory. Throws
    /// Error{out_of_memory}.
    /// `last_head`: units after which places are numbered afresh and all trees are forgotten.
    PatchTreeCache(const Device& device, uint64_t cap_bytes, uint32_t last_head);

    void bind(BindingTable& bindings) const;

    /// Before the jobs of a chunk of rays are found, whose records it may clear: `trees` are those of all
    /// trees.
    void begin_chunk(const Buffer& trees, Commands& commands);

    /// Fills in what a wave of jobs is told. Records what must be done before it; `trees` are the records of
    /// all trees.
    void begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands);
    /// `pool_head` as the wave left it.
    void end_wave(const scalar::CounterData& counters);

  private:
    Buffer pool_;
    bool is_kept_;
    uint32_t last_head_;
    uint32_t capacity_; ///< units
    uint32_t head_ = 0; ///< units filled so far
    uint32_t wave_ = 0;
};

} // namespace relief::vulkan
