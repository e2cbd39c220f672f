// Device buffers of a cast: rays, hits, intermediate results of its stages, and counters.
#pragma once

#include "vulkan/device/commands.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

class CastBuffers {
  public:
    CastBuffers(const Device& device, const TracerConfig& config, uint64_t histogram_words);

    void bind(BindingTable& bindings) const;

    /// Grows the tree records to `count`; existing records are kept.
    void reserve_trees(const Device& device, uint32_t count, Commands& commands, BindingTable& bindings);
    /// Maximum number of trees with pairs at a time; the size of each build bin.
    uint32_t job_capacity() const { return job_capacity_; }

    /// Makes the rays of the next round the active ones.
    void swap_active(BindingTable& bindings);

    Buffer rays, hits, active, next_active, cursors, candidates, pairs, sorted_pairs, histogram, trees,
        nearest, counters, counters_on_host, jobs, builds, arguments, requests;

  private:
    uint32_t pair_capacity_;
    uint32_t tree_capacity_ = 0, job_capacity_ = 0;
};

/// Size of one entry of `arguments`.
inline constexpr uint64_t kArgumentBytes = scalar::kArgumentWords * sizeof(uint32_t);

/// Patches whose tiles can be requested at a time; further ones are requested again.
inline constexpr uint32_t kRequestCapacity = 4096;

} // namespace relief::vulkan
