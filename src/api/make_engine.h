// Creates the engine selected by the settings. The only place that depends on both engines and on the
// laboratory's traversals.
#pragma once

#include <memory>

#include "engine/engine.h"

namespace relief {

/// Throws Error{device_missing} for an instruction set or a device that is not available.
std::unique_ptr<Engine> make_engine(std::shared_ptr<const PreparedScene> scene,
                                    const RenderSettings& settings);

} // namespace relief
