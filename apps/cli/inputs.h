// Files that a command reads: what it writes never takes their place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief::cli {

/// Files that a scene was read from, as far as they are known: its own, meshes, maps, textures.
std::vector<std::string> list_files(const Scene& scene);

/// Where a file is or would be, without links in its folder: names with <UDIM> are no files.
std::filesystem::path find_place(const std::filesystem::path& file);

/// Throws Error{usage}: `output` is read as well.
[[noreturn]] void refuse_output(const std::filesystem::path& output);

/// Throws Error{usage} where `output`, which may be empty, is one of the files, under whatever name. Files
/// may be empty, or "-" for standard input.
void keep_files(const std::vector<std::string>& files, const std::filesystem::path& output);

} // namespace relief::cli
