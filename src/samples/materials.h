// Twelve squashes of twelve materials: what base, coat and fuzz look like on displaced bodies.
#pragma once

#include "relief/samples.h"

namespace relief::samples {

Scene make_materials_scene(Instancing instancing, const ProgressFunction& on_progress);

} // namespace relief::samples
