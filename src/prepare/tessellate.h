// The baseline of direct tracing: all the same vertices as plain quads in the same tracer.
#pragma once

#include "prepare/prepared_scene.h"
#include "relief/inspect.h"

namespace relief {

/// Of a scene that is not tessellated yet, at the levels of its instances.
TessellationCost estimate_tessellation(const PreparedScene& scene);

/// Replaces displaced surfaces by their micro-quads at each instance's levels. Error{out_of_memory} first.
void tessellate_scene(PreparedScene& scene, uint64_t available_bytes);

} // namespace relief
