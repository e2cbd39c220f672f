// Files that a job reads, as they were when it was planned.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/report.h"

namespace relief::cli {

struct InputFile {
    std::filesystem::path file; ///< absolute
    uint64_t size_bytes = 0;
    int64_t modified = 0, changed = 0; ///< nanoseconds; the latter is the system's own, which nobody can set
    std::string hash;                  ///< of its content, 16 hexadecimal digits
};

/// Reads and hashes a file. Throws Error{bad_input} where that cannot be done.
InputFile describe_file(const std::filesystem::path& file);

/// Throws Error{bad_input} where the files are not those of the list any more, and for one that is not in it.
/// A file whose size and both times are as they were is not read again: nothing has written to it since.
/// Others, copies of those files say, are read and hashed.
void check_files(const std::vector<InputFile>& planned, const std::vector<std::filesystem::path>& files);

/// As an entry of the manifest, and back.
Value describe_input_file(const InputFile& file);
InputFile read_input_file(const Value& value);

} // namespace relief::cli
