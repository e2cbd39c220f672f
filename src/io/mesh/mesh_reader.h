// load_mesh, and what it noticed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// As load_mesh; what of the file does not show in the mesh is added to `warnings`, with the name of the
/// file.
Mesh read_mesh_file(const std::filesystem::path& file, const MeshReadOptions& options,
                    std::vector<std::string>& warnings);

} // namespace relief
