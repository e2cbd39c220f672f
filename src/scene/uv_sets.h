// Uv sets that textures of materials lie on, by number.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Numbers that textures of a material, or of any of them, name; rising, each once.
std::vector<int> list_uv_sets(const Material& material);
std::vector<int> list_uv_sets(std::span<const Material> materials);

/// Whether some faces of the mesh have uvs in the set of that number.
bool has_uv_set(const Mesh& mesh, int number);

/// The further set of that number; null where it is the own one of the mesh, or there is none.
const UvSet* find_further_set(const Mesh& mesh, int number);

/// "uv set 0", "uv sets 0 and 2" or "no uvs".
std::string describe_uv_sets(const Mesh& mesh);

} // namespace relief
