// A mesh passed by a child process in shared memory: header and arrays, or an error. Untrusted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/error.h"
#include "relief/scene.h"

namespace relief {

/// Writes all but name, source, subdivision and weld. Throws std::system_error (ENOSPC, EFBIG) where memory
/// ends.
void write_mesh_block(int descriptor, const Mesh& mesh, const std::vector<std::string>& warnings = {});

/// Writes an error in place of a mesh. Throws std::system_error.
void write_error_block(int descriptor, const Error& error);

/// Writes that memory did not suffice; allocates nothing. Throws std::system_error.
void write_memory_block(int descriptor);

enum class BlockContent { nothing, mesh, error, out_of_memory };

struct MeshBlock {
    BlockContent content = BlockContent::nothing;
    Mesh mesh;
    std::vector<std::string> warnings; ///< of the reader, with a mesh
    ErrorKind error_kind = ErrorKind::bad_input;
    Error::Parts error;
};

/// Reads a block that whoever wrote it may have damaged, at most `most_bytes` of it. What is not whole or
/// holds an index out of range counts as nothing. Control characters of texts become '?'. The values
/// are copied before they are checked, so that the writer cannot change them afterwards.
MeshBlock read_mesh_block(int descriptor, uint64_t most_bytes);

} // namespace relief
