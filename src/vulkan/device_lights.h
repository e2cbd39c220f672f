// Materials and lights in device memory, for the path tracing kernels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "prepare/prepared_scene.h"
#include "vulkan/device/buffer.h"
#include "vulkan/device/kernel.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/device_paths.h"

namespace relief::vulkan {

/// Immutable once made. Throws Error{out_of_memory}.
class DeviceLights {
  public:
    DeviceLights(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene);

    void bind(BindingTable& bindings) const;
    /// Constants of a kernel that draws lights or meets them, or of one that leads to such.
    std::vector<uint32_t> add_choice(std::vector<uint32_t> constants) const;
    /// Fills in the light parameters of `push`; the rest is unchanged.
    void describe(scalar::PathPush& push) const;

  private:
    Buffer materials_, sources_, environment_, emitters_;
    std::optional<Buffer> albedos_; ///< where materials have layers; else those of every table
    scalar::PathPush description_{};
    bool has_links_ = false, has_textures_ = false;
};

} // namespace relief::vulkan
