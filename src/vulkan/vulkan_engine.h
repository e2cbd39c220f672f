// The engine that runs on a Vulkan device.
#pragma once

#include <memory>
#include <optional>

#include "engine/engine.h"
#include "vulkan/device/device.h"
#include "vulkan/scene_walk.h"

namespace relief {

namespace vulkan {

/// `walk`, unless empty, replaces the engine's traversal. Throws Error{out_of_memory} for too large scenes.
std::unique_ptr<Engine> make_engine_on(std::unique_ptr<Device> device,
                                       std::shared_ptr<const PreparedScene> scene,
                                       const RenderSettings& settings,
                                       const std::optional<SceneWalk>& walk = {});

} // namespace vulkan

/// The same on the settings' device. Throws Error{device_missing} if it is absent or lacks features.
std::unique_ptr<Engine> make_vulkan_engine(std::shared_ptr<const PreparedScene> scene,
                                           const RenderSettings& settings,
                                           const std::optional<vulkan::SceneWalk>& walk = {});

} // namespace relief
