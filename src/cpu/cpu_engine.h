// The engine that runs on the processor.
#pragma once

#include <memory>

#include "cpu/traversal/scene_walk.h"
#include "engine/engine.h"

namespace relief {

/// `walk` takes the place of the engine's own traversal of the scene, unless it is null. Throws
/// Error{device_missing} for an instruction set that this machine lacks.
std::unique_ptr<Engine> make_cpu_engine(std::shared_ptr<const PreparedScene> scene,
                                        const RenderSettings& settings,
                                        std::unique_ptr<const cpu::SceneWalk> walk = nullptr);

} // namespace relief
