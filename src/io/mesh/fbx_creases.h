// Creases of an FBX mesh.
#pragma once

#include <vector>

#include "io/mesh/fbx_facts.h"

namespace relief {

/// Reads the creases of a record `Geometry`. Values that do not fit the mesh are left out.
std::vector<FbxCrease> read_fbx_creases(const FbxDocument& document, const FbxRecord& geometry);

} // namespace relief
