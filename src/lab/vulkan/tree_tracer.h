// Rays through one tree over one triangle mesh, by any traversal of lab/walks/traverse_*.h.
#pragma once

#include <map>
#include <string>

#include "lab/trees.h"
#include "lab/vulkan/device_tree.h"
#include "vulkan/device/commands.h"

namespace relief::vulkan {

/// What goes into a walk and comes out of it, all in device memory; other kernels may write the rays.
struct TreeRays {
    /// Throws Error{out_of_memory}.
    TreeRays(const Device& device, uint32_t capacity);

    uint32_t capacity;
    Buffer rays;       ///< scalar::TreeRay
    Buffer hits;       ///< scalar::TreeHit
    Buffer start_keys; ///< scalar::HeapKey, of a node in the heap; see WalkStart
    Buffer leaf_keys;  ///< scalar::HeapKey
    Buffer counts;     ///< scalar::RayCounts, where they are counted
};

/// last_leaf: each ray starts at its start_keys, and leaf_keys receive the leaf of its hit, its start where
/// nothing is hit (closest_hit_from and any_hit_from of lab/walks/walks.h). Heaps only.
enum class WalkStart { root, last_leaf };

/// One thread at a time. The device must outlive it.
class TreeTracer {
  public:
    explicit TreeTracer(const Device& device);

    /// The first `ray_count` rays. Closest hits: the nearest, ties to the lowest primitive, whatever the
    /// tree; bits as on the CPU where the device divides exactly. Throws Error{usage} for a tree that the
    /// traversal cannot walk, Error{failed} when the device ended a walk early: no ray is lost in silence.
    void trace(const DeviceTree& tree, const DeviceMesh& mesh, TreeRays& rays, uint32_t ray_count,
               const TreeQuery& query, WalkStart start = WalkStart::root);

    /// Of the last trace, without uploads.
    double seconds() const { return seconds_; }

    /// That for trees of this form and depth; compiled when first asked for.
    const Kernel& find_kernel(const DeviceTree& tree, const TreeQuery& query);

  private:
    void bind(const DeviceTree& tree, const DeviceMesh& mesh, const TreeRays& rays);

    const Device& device_;
    BindingTable bindings_;
    Commands commands_;
    std::map<std::string, Kernel> kernels_; ///< by shader and constants; made when first used
    Buffer state_;
    double seconds_ = 0;
};

} // namespace relief::vulkan
