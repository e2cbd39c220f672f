// Procedural sample scenes.
#pragma once

#include <string>
#include <vector>

#include "relief/progress.h"
#include "relief/scene.h"

namespace relief {

enum class Instancing { none, shared };

/// Valid names for make_sample_scene: pumpkin, bark, barks, party, ear, materials, shot.
std::vector<std::string> sample_scene_names();

/// Builds a sample scene in memory. Throws Error{usage} for an unknown name.
Scene make_sample_scene(const std::string& name, Instancing instancing,
                        const ProgressFunction& on_progress = {});

/// What moves in it after the first frame; nothing, but in `shot`. Throws as make_sample_scene.
SceneMotion make_sample_motion(const std::string& name, const ProgressFunction& on_progress = {});

} // namespace relief
