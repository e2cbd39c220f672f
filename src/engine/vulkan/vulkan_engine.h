// The Vulkan engine on a device that the caller has made.
#pragma once

#include <memory>

#include "engine/engine.h"
#include "engine/vulkan/device.h"

namespace relief::vulkan {

/// Throws Error{out_of_memory} for a scene that the device cannot hold.
std::unique_ptr<Engine> make_engine_on(std::unique_ptr<Device> device,
                                       std::shared_ptr<const PreparedScene> scene,
                                       const RenderSettings& settings);

} // namespace relief::vulkan
