// Levels of all instances, as the camera and the settings choose them.
#pragma once

#include "prepare/prepared_scene.h"

namespace relief {

/// Computes PreparedScene::levels and those of the instances anew, for the scene's camera.
void update_scene_levels(PreparedScene& scene, const RenderSettings& settings);

} // namespace relief
