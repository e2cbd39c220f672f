// Reads meshes by third-party libraries in a child process, so that a crash ends the child alone.
#pragma once

#include <filesystem>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// Starts `options.reader.program` for this file, waits for it and takes the mesh over, as load_mesh would
/// read it in this process, without name and source, and its warnings. The child runs no code of this
/// process: other threads may hold locks. Throws the Error of the child's load_mesh; Error{bad_input} where
/// the child was ended by a signal, reached a limit or left no mesh; Error{failed} where it cannot be started
/// or was cancelled. For any thread; the child ends with the thread that waits for it.
Mesh read_mesh_in_child(const std::filesystem::path& file, const MeshReadOptions& options,
                        std::vector<std::string>& warnings);

/// The descriptor by which the child gets the shared memory.
inline constexpr int kSharedMemory = 3;

/// First word after the child's name, before file, uv sets ("0" or "0,1,2": that of the mesh first), bytes of
/// memory and stack, and the parent's id.
inline constexpr const char* kReadMeshWord = "--read-mesh";

} // namespace relief
