// Ranges of the settings that callers hand in.
#pragma once

#include "relief/render.h"

namespace relief {

/// Throws Error{usage} that names the setting and its range.
void validate_settings(const RenderSettings& settings);

} // namespace relief
