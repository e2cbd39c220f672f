// The engine that settings name. The one place that knows both, and the laboratory's traversals.
#pragma once

#include <memory>

#include "engine/engine.h"

namespace relief {

/// Throws Error{device_missing} for an instruction set or a device that is not there.
std::unique_ptr<Engine> make_engine(std::shared_ptr<const PreparedScene> scene,
                                    const RenderSettings& settings);

} // namespace relief
