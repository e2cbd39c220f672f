// What a displaced surface shows of its map's space, once it is there: tangent space is what a map is taken
// for where nothing is said, and one in object space then looks torn and swollen, which says nothing of the
// cause.
#pragma once

#include <string>
#include <vector>

#include "prepare/prepared_scene.h"

namespace relief {

/// Of surfaces in tangent space whose uv seams speak for object space. Takes well below a millisecond a
/// surface: few seams are looked at.
std::vector<std::string> find_space_warnings(const PreparedScene& scene);

} // namespace relief
