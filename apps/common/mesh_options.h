// Options for rendering a mesh without a scene file, for the verbs that accept one.
#pragma once

#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/io.h"

namespace relief::cli {

/// The value of --weld. Throws Error{usage}.
float parse_weld(const std::string& text);

/// The value of --up. Throws Error{usage}.
UpAxis parse_up_axis(const std::string& text);

/// Adds --vdm, --subdivision, --subdivision-level, --weld, --up, --filter, --dequantize, --autobump and
/// --no-dilate, and sets the reader to that of make_mesh_reader(). Given options are appended to `given`; all
/// arguments must outlive parsing.
void add_mesh_options(CLI::App& verb, const std::string& group, MeshSceneOptions& options,
                      std::vector<std::string>& given);

/// Throws Error{usage} for options that have no effect without another one.
void check_mesh_options(const MeshSceneOptions& options);

/// The same for options of the map convention.
void check_map_options(const MeshSceneOptions& options);

} // namespace relief::cli
