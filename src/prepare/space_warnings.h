// Warnings of a wrong space: an object-space map that is read as tangent looks torn and swollen.
#pragma once

#include <string>
#include <vector>

#include "prepare/prepared_scene.h"

namespace relief {

/// Of surfaces in tangent space whose uv seams speak for object space. Takes under a millisecond a surface.
std::vector<std::string> find_space_warnings(const PreparedScene& scene);

} // namespace relief
