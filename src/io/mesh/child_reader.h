// Reads meshes by third-party libraries in a child process, so that a crash ends the child alone.
#pragma once

#include <filesystem>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// Runs `options.reader.program` on this file and takes the mesh over, as load_mesh would read it here,
/// without name and source. The child runs no code of this process. Throws the Error of the child's
/// load_mesh; bad_input where a signal or limit ended it or it left no mesh; failed where it cannot start or
/// was cancelled. For any thread; the child ends with the thread.
Mesh read_mesh_in_child(const std::filesystem::path& file, const MeshReadOptions& options);

/// The descriptor by which the child gets the shared memory.
inline constexpr int kSharedMemory = 3;

/// First word after the child's name, before file, uv set, bytes of memory and stack, and the parent's id.
inline constexpr const char* kReadMeshWord = "--read-mesh";

} // namespace relief
