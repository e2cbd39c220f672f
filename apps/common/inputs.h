// Input files of a command, which its output must never overwrite.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "relief/error.h"
#include "relief/scene.h"

namespace relief::cli {

enum class FileKind { map, mesh, scene };

/// By its suffix. What is neither mesh nor scene is taken for a map, of which its reader says what is wrong.
FileKind get_kind(const std::filesystem::path& file);

/// Files that a scene was read from, as far as known: scene file, meshes, maps, textures.
std::vector<std::string> list_files(const Scene& scene);

/// Throws Error{bad_input}: nothing of the scene can be seen, neither objects nor an environment nor a light.
void refuse_empty_scene(const Scene& scene, const std::filesystem::path& file);

/// Throws Error{kind} for a symbolic link, or a path through one, that leads back to itself.
void refuse_link_loop(const std::filesystem::path& file, ErrorKind kind);

/// Path of an existing or future file with symbolic links of its folder resolved; names with <UDIM> are not
/// files.
std::filesystem::path find_place(const std::filesystem::path& file);

/// Throws Error{usage}: `output` is also an input.
[[noreturn]] void refuse_output(const std::filesystem::path& output);

/// Throws Error{usage} if `output`, which may be empty, is the same file as an input. Inputs may be empty, or
/// "-" for standard input.
void keep_files(const std::vector<std::string>& files, const std::filesystem::path& output);

} // namespace relief::cli
