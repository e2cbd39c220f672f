// Levels of all instances, as the camera and the settings choose them.
#pragma once

#include "prepare/prepared_scene.h"

namespace relief {

/// Whether lines are measured once for all views to come, which takes 192 bytes a patch of an instance.
enum class ViewsToCome { none, many };

/// How levels are chosen for a camera and the settings of a picture.
LevelFieldConfig make_level_config(const Camera& camera, const RenderSettings& settings);

/// Computes PreparedScene::levels and those of the instances anew, for the scene's camera.
void update_scene_levels(PreparedScene& scene, const RenderSettings& settings,
                         ViewsToCome views = ViewsToCome::none);

} // namespace relief
