// The baseline of direct tracing: all the same vertices as plain quads in the same tracer.
#pragma once

#include "prepare/prepared_scene.h"
#include "relief/inspect.h"

namespace relief {

/// Of a scene that is not tessellated yet, at the levels of its instances.
TessellationCost estimate_tessellation(const PreparedScene& scene);

/// Replaces every displaced surface by its micro-quads at the levels of each instance (equal ones share
/// them). Throws Error{out_of_memory} with the byte count beforehand.
void tessellate_scene(PreparedScene& scene, uint64_t available_bytes);

} // namespace relief
