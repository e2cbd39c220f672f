// The engine that runs on the processor.
#pragma once

#include <memory>

#include "cpu/traversal/scene_walk.h"
#include "engine/engine.h"

namespace relief {

/// `walk` replaces the default traversal. Throws Error{device_missing} for a missing instruction set.
std::unique_ptr<Engine> make_cpu_engine(std::shared_ptr<const PreparedScene> scene,
                                        const RenderSettings& settings,
                                        std::unique_ptr<const cpu::SceneWalk> walk = nullptr);

} // namespace relief
