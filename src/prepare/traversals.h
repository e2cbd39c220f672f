// What ExperimentSettings::structure and traversal stand for.
#pragma once

#include "relief/render.h"

namespace relief {

/// The traversal that `automatic` means for an engine; else the one that is named.
TraversalKind choose_traversal(const RenderSettings& settings, EngineKind engine);

/// Whether an engine walks its own trees in its own way.
bool is_default_traversal(const RenderSettings& settings, EngineKind engine);

} // namespace relief
