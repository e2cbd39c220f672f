// Ranges of the settings that callers hand in.
#pragma once

#include "relief/render.h"

namespace relief {

/// Throws Error{usage} that names the setting and its range.
void validate_settings(const RenderSettings& settings);

/// Throws Error{usage} for a camera whose pictures the settings' method cannot make.
void validate_method(const RenderSettings& settings, const Camera& camera);

bool has_shadow_catchers(const Scene& scene);

/// With the layer that pictures of shadow catchers have besides, where there are some. Throws Error{usage}
/// for a setting that does not go with them.
RenderSettings complete_settings(RenderSettings settings, bool has_catchers);

} // namespace relief
