// Options that say what a mesh is rendered with that comes without a scene file, for the verbs that take one.
#pragma once

#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/io.h"

namespace relief::cli {

/// Adds --vdm, --subdivision, --subdivision-level, --filter, --autobump and --no-dilate. Those that are given
/// are added to `given`; what they refer to must outlive the parsing.
void add_mesh_options(CLI::App& verb, const std::string& group, MeshSceneOptions& options,
                      std::vector<std::string>& given);

/// Throws Error{usage} for options that say nothing without another one.
void check_mesh_options(const MeshSceneOptions& options);

/// The same for those that say what a map means.
void check_map_options(const MeshSceneOptions& options);

} // namespace relief::cli
