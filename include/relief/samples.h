// Procedural sample scenes.
#pragma once

#include <string>
#include <vector>

#include "relief/progress.h"
#include "relief/scene.h"

namespace relief {

enum class Instancing { none, shared };

/// Valid names for make_sample_scene: pumpkin, bark, barks, party, ear, materials.
std::vector<std::string> sample_scene_names();

/// Builds a sample scene in memory. Throws Error{usage} for an unknown name.
Scene make_sample_scene(const std::string& name, Instancing instancing,
                        const ProgressFunction& on_progress = {});

} // namespace relief
