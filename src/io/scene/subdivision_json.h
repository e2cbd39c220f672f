// The key "subdivision" of a mesh in a scene file.
#pragma once

#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// Sets `mesh.subdivision`; creases listed in the file are added to those that the mesh has.
void read_subdivision(const JsonNode& node, Mesh& mesh);

/// True where a mesh is more than its polygons.
bool has_subdivision(const Mesh& mesh);
/// What read_subdivision reads again, every crease listed.
Json write_subdivision(const Mesh& mesh);

} // namespace relief
