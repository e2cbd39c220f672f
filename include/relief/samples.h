// Sample scenes of the project, made from nothing but formulas and a seed.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

enum class Instancing { none, shared };

/// Names that make_sample_scene knows: pumpkin, bark, barks, party, ear.
std::vector<std::string> sample_scene_names();

/// Builds a sample scene in memory. Throws Error{usage} for an unknown name.
Scene make_sample_scene(const std::string& name, Instancing instancing);

} // namespace relief
