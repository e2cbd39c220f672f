// Rays against the scene on the device: rounds of upper traversal, sort, patch trees and bottom traversal
// until no ray has anything left in front of its hit. The counterpart of cpu/tracer.h.
#pragma once

#include <memory>

#include "prepare/prepared_scene.h"
#include "relief/render.h"
#include "vulkan/device/commands.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan {

/// What changes how work is cut, never what comes out.
struct TracerConfig {
    uint32_t ray_capacity = 1u << 20; ///< entries of rays and hits; lists hold as many
    uint32_t slots = 4; ///< nearest patches that a ray offers in its first round, [1, 8]; twice as many later
    uint32_t pair_capacity =
        1u << 22; ///< pairs of ray and patch at once, >= slots; fewer: more chunks of rays
    uint32_t pool_restart_units = 1u << 31; ///< of trees built, after which the pool forgets all of them
    uint32_t fused_group_count = 0;         ///< resident groups of the fused form; 0: what fills the device
    uint32_t fused_jobs_per_group =
        0;                        ///< trees that such a group takes in one launch; 0: as many as are safe
    bool may_see_coarser = false; ///< rays may have a bias; those of a render have none
};

/// One thread at a time. All of it is synchronous.
class Tracer {
  public:
    /// Device and scene must outlive it. Throws Error{out_of_memory}.
    Tracer(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene,
           const RenderSettings& settings, const TracerConfig& config);
    ~Tracer();

    /// Nearest hits of the first `count` rays that `list` names (numbers into kBindRays), into kBindHits.
    CastStatistics closest_hits(const Buffer& list, uint32_t count);
    /// Whether anything is in the way: HitData::instance is kNone where nothing is.
    CastStatistics any_hits(const Buffer& list, uint32_t count);

    /// Of all rays from now on: instances are met whose mask shares a bit. Everything to begin with.
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
    /// CounterData; path_count and shadow_count belong to whoever shades.
    const Buffer& counter_buffer() const;
    /// Runs what was recorded and fetches the counters.
    const scalar::CounterData& read_counters();

    /// What was done so far: pairs, trees, bytes.
    void add_statistics(Statistics& statistics) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::vulkan
