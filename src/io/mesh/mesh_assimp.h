// FBX through Assimp: polygons kept, node transforms applied, positions welded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// All meshes of the file as one, turned so that its up axis is y and its front axis is z. Lengths stay the
/// numbers of the file: for units other than centimetres and metres a warning is added. Throws bad_input with
/// file and reason, std::bad_alloc.
Mesh read_assimp_mesh(const std::filesystem::path& file, const MeshReadOptions& options,
                      std::vector<std::string>& warnings);

} // namespace relief
