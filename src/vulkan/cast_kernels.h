// The kernels of a cast, specialised for the device, the leaf kind and the form of the patch tree kernels.
#pragma once

#include <array>
#include <optional>

#include "vulkan/device/kernel.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

struct CastKernels {
    /// `tile_stack_size`: entries needed for the tiles of a patch; 0: there are none.
    CastKernels(const Device& device, const DeviceScene& scene, const RenderSettings& settings,
                const TracerConfig& config, uint32_t tile_stack_size);

    /// The fused form leaves excess pairs of large trees to `leftover` on devices that limit loops.
    bool is_fused, has_leftover = false;
    uint32_t fused_group_count = 0, fused_jobs_per_group = 0;
    scalar::ArgumentsPush arguments_push; ///< for prepare_arguments

    Kernel scene_traversal, find_jobs, prepare_arguments, bottom_cache, patch_traversal, bottom_fused,
        leftover, commit_round, finish_hits;
    std::optional<Kernel> collecting_traversal; ///< of the round in which rays offer all candidates left
    /// One per bin that trees of the scene can fall into; none in the fused form.
    std::array<std::optional<Kernel>, scalar::kBuildBinCount> bottom_build;
};

} // namespace relief::vulkan
