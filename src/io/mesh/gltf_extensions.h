// Extensions of glTF: which of them are applied, change no mesh, or stand in the way.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/gltf_file.h"

namespace relief {

/// Throws bad_input for a required extension that is neither applied nor without effect on meshes. Others
/// that nodes, meshes or their parts have, and that are not applied, are added to `warnings`.
void check_gltf_extensions(const GltfFile& file, std::vector<std::string>& warnings);

/// Whether KHR_node_visibility hides a node and all below it.
bool is_hidden_gltf_node(const JsonNode& node);

} // namespace relief
