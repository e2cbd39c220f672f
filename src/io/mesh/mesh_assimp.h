// FBX through Assimp: polygons kept, node transforms applied, positions welded.
#pragma once

#include <filesystem>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// All meshes of the file as one. Throws bad_input with file and reason, std::bad_alloc.
Mesh read_assimp_mesh(const std::filesystem::path& file, const MeshReadOptions& options);

} // namespace relief
