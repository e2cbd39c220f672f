// Which UDIM tiles the textures of materials lack where meshes read them.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Warnings about textures with tiles, one by one for each mesh that has their material: files that are
/// missing, and faces outside of all tiles. Faces across tiles are no fault here: each look-up goes to the
/// tile that its uv is in. Indices of objects must be valid.
std::vector<std::string> find_texture_tile_warnings(const Scene& scene);

} // namespace relief
