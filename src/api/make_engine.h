// Creates the engine that the settings select. Only this depends on both engines and on the laboratory.
#pragma once

#include <memory>

#include "engine/engine.h"

namespace relief {

/// Throws Error{device_missing} for an instruction set or a device that is not available.
std::unique_ptr<Engine> make_engine(std::shared_ptr<const PreparedScene> scene,
                                    const RenderSettings& settings);

} // namespace relief
