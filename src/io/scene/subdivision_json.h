// The key "subdivision" of a mesh in a scene file, and its words on the command line.
#pragma once

#include <string_view>

#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// Throw bad_input with a suggestion for an unknown word.
SubdivisionScheme parse_subdivision_scheme(std::string_view text);
UvRule parse_uv_rule(std::string_view text);
BoundaryRule parse_boundary_rule(std::string_view text);

/// Sets `mesh.subdivision`; creases listed in the file are added to those that the mesh has.
void read_subdivision(const JsonNode& node, Mesh& mesh);

/// True where a mesh is more than its polygons.
bool has_subdivision(const Mesh& mesh);
/// What read_subdivision reads again, every crease listed.
Json write_subdivision(const Mesh& mesh);

} // namespace relief
