// What a scene's hash says of its meshes and pictures.
#pragma once

#include "base/content_hash.h"
#include "relief/scene.h"

namespace relief {

/// Adds the meshes, the numbers of map tiles, and the size and texels of every texture of a scene once.
void add_scene_content(ContentHash& hash, const Scene& scene);

} // namespace relief
