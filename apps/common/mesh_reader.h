// How the programs read meshes whose format a third-party library parses.
#pragma once

#include "relief/io.h"

namespace relief::cli {

/// In a child process, which is the running program again: its main() begins with run_mesh_reader().
inline MeshReaderSettings make_mesh_reader() {
    MeshReaderSettings reader;
    reader.program = "/proc/self/exe";
    return reader;
}

} // namespace relief::cli
