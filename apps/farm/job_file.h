// Files of a job folder, which other machines and people may have changed: pipes are not opened, which may
// wait for ever, and symbolic links that lead out of the job are not followed.
#pragma once

#include <filesystem>
#include <istream>
#include <memory>

#include "farm/job.h"

namespace relief::cli {

/// Throws Error{bad_input} for a file or folder that is there and lies outside of the job, by a symbolic link
/// anywhere below the job folder, and for what is neither a file nor a folder.
void check_job_file(const FarmJob& job, const std::filesystem::path& file);

/// A binary stream; null where there is no such file. Throws like check_job_file.
std::unique_ptr<std::istream> open_job_file(const FarmJob& job, const std::filesystem::path& file);

/// Makes a folder of the job. Throws Error{failed}, which explains rights and space, and like check_job_file.
void make_job_folder(const FarmJob& job, const std::filesystem::path& folder);

} // namespace relief::cli
