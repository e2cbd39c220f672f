// Bodies afloat on moving water: a scene of 24 frames.
#pragma once

#include "relief/samples.h"

namespace relief::samples {

/// Its first frame.
Scene make_shot_scene(Instancing instancing, const ProgressFunction& on_progress);

SceneMotion make_shot_motion(const ProgressFunction& on_progress);

} // namespace relief::samples
