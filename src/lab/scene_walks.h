// Scene traversals chosen by name (ExperimentSettings::structure and traversal), for both engines.
#pragma once

#include <memory>
#include <optional>

#include "cpu/traversal/scene_walk.h"
#include "prepare/prepared_scene.h"
#ifdef RELIEF_VULKAN
#include "vulkan/scene_walk.h"
#endif

namespace relief {

/// Null where the settings name the engine's own traversal.
std::unique_ptr<const cpu::SceneWalk> make_scene_walk(const PreparedScene& scene,
                                                      const RenderSettings& settings);

#ifdef RELIEF_VULKAN
namespace vulkan {

/// Walks trees of up to `depth` levels in that way.
TraversalKernel find_walk_kernel(TraversalKind traversal, int depth);

/// Empty where the settings name the engine's own traversal.
std::optional<SceneWalk> make_device_walk(const PreparedScene& scene, const RenderSettings& settings);

} // namespace vulkan
#endif

} // namespace relief
