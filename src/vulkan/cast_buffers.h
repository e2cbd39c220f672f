// Device memory of a cast: rays and hits, what passes between its stages, and the counters.
#pragma once

#include "vulkan/device/commands.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

class CastBuffers {
  public:
    CastBuffers(const Device& device, const TracerConfig& config, uint64_t histogram_words);

    void bind(BindingTable& bindings) const;

    /// Makes room for as many trees; records of trees that are there already are kept.
    void reserve_trees(const Device& device, uint32_t count, Commands& commands, BindingTable& bindings);
    uint32_t tree_capacity() const { return tree_capacity_; }
    /// Trees that can have pairs at once: places of each bin of builds.
    uint32_t job_capacity() const { return job_capacity_; }

    /// The rays of the next round become those of this one.
    void swap_active(BindingTable& bindings);

    Buffer rays, hits, active, next_active, cursors, candidates, pairs, sorted_pairs, histogram, trees,
        nearest, counters, counters_on_host, jobs, builds, arguments, requests;

  private:
    uint32_t pair_capacity_;
    uint32_t tree_capacity_ = 0, job_capacity_ = 0;
};

/// One entry of `arguments`.
inline constexpr uint64_t kArgumentBytes = scalar::kArgumentWords * sizeof(uint32_t);

/// Patches whose tiles can be asked for at once; more ask again.
inline constexpr uint32_t kRequestCapacity = 4096;

} // namespace relief::vulkan
