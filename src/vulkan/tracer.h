// Device ray casting: rounds of scene traversal, sort, tree build and patch traversal till all is hit.
#pragma once

#include <memory>
#include <optional>

#include "prepare/prepared_scene.h"
#include "relief/render.h"
#include "vulkan/device/commands.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/patch_tree_cache.h"

namespace relief::vulkan {

/// How work is partitioned; never changes the result.
struct TracerConfig {
    uint32_t ray_capacity = 1u << 20; ///< capacity of the ray and hit buffers and of lists
    uint32_t slots =
        4; ///< nearest candidates that a ray offers in its first round, [1, 8]; twice as many later
    /// Candidates that a ray may offer, all that it has left, in the first of the later rounds that has room
    /// for so many of each ray; 0: there is no such round.
    uint32_t collected = 0;
    uint32_t pair_capacity =
        1u << 22; ///< capacity for pairs of ray and patch, >= slots; a smaller one means more chunks of rays
    uint32_t pool_restart_units = 1u << 31; ///< units of trees built, after which the pool discards all trees
    std::optional<PoolGrowth> pool_growth;  ///< of the pool of trees; not given: choose_pool_growth()
    uint32_t fused_group_count = 0;    ///< persistent groups of the fused form; 0: enough to fill the device
    uint32_t fused_jobs_per_group = 0; ///< trees per group and launch; 0: as many as are safe
    bool builds_as_gpu = false;        ///< trees in the large groups that GPUs have, on a CPU device, too
    bool may_see_coarser = false;      ///< rays may have an LOD bias, beside the bounces of a render
};

/// Not thread safe; all calls are synchronous.
class Tracer {
  public:
    /// Device and scene must outlive it. Throws Error{out_of_memory}.
    Tracer(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene,
           const RenderSettings& settings, const TracerConfig& config);
    ~Tracer();

    /// Nearest hits of the first `count` rays of `list` (indices into kBindRays), into kBindHits.
    CastStatistics closest_hits(const Buffer& list, uint32_t count);
    /// Any hit: HitData::instance is kNone for unoccluded rays.
    CastStatistics any_hits(const Buffer& list, uint32_t count);

    /// Visibility mask of all subsequent rays: instances are hit whose mask shares a bit. Initially all bits.
    void set_visibility_mask(uint32_t mask);

    BindingTable& bindings();
    Commands& commands();
    const Device& device() const;
    const DeviceScene& device_scene() const;
    const PreparedScene& scene() const;
    /// RayData and HitData, ray_capacity entries each.
    Buffer& rays();
    const Buffer& hits() const;
    const TracerConfig& config() const;
    /// CounterData; path_count and shadow_count are for the caller's shading kernels.
    const Buffer& counter_buffer() const;
    /// Submits the recorded commands, waits and reads the counters.
    const scalar::CounterData& read_counters();

    /// Adds pairs, trees and bytes so far.
    void add_statistics(Statistics& statistics) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
