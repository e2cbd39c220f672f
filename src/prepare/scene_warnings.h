// What a scene is warned of when it is prepared: things that render, but hardly as they are meant.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Nothing to be seen or nothing that gives light; tiles that displaced meshes use and no file has; creases
/// of smooth bases that their level cannot show. The scene must be valid.
std::vector<std::string> find_scene_warnings(const Scene& scene);

} // namespace relief
