// The scene with everything in it: 106,000 displaced patches of five models among plain triangles.
#pragma once

#include "relief/samples.h"

namespace relief::samples {

Scene make_party_scene(Instancing instancing, const ProgressFunction& on_progress);

} // namespace relief::samples
