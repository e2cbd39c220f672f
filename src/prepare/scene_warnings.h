// What a scene is warned of when it is prepared: things that render, but hardly as they are meant.
#pragma once

#include <string>
#include <vector>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

/// Nothing visible or no light; missing tiles; creases that are too fine for their level; noise that is asked
/// for and never judged. Valid scenes only. Edges that nearly coincide are found by find_edge_warnings().
std::vector<std::string> find_scene_warnings(const Scene& scene, const ImageSettings& image);

} // namespace relief
