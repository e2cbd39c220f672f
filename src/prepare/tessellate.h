// The baseline that direct tracing is compared with: the same vertices, all of them, as plain quads in the
// same tracer.
#pragma once

#include "prepare/prepared_scene.h"
#include "relief/inspect.h"

namespace relief {

/// Of a scene that is not tessellated yet, at the levels of its instances.
TessellationCost estimate_tessellation(const PreparedScene& scene);

/// Replaces every displaced surface by its micro-quads at the levels of each instance (instances with equal
/// levels share them). Throws Error{out_of_memory} beforehand, with the byte count, when the machine cannot
/// hold it.
void tessellate_scene(PreparedScene& scene, uint64_t available_bytes);

} // namespace relief
