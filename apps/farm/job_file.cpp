#include "farm/job_file.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "farm/attempts.h"
#include "relief/error.h"

namespace relief::cli {

namespace fs = std::filesystem;

namespace {

bool is_inside(const fs::path& file, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

} // namespace

void check_job_file(const FarmJob& job, const fs::path& file) {
    std::error_code code;
    const fs::file_status status = fs::symlink_status(file, code);
    if (!fs::exists(status)) return;
    const fs::path place = fs::canonical(file, code);
    if (code && code != std::errc::no_such_file_or_directory)
        return; // opening it fails as well, and says why
    const fs::path folder = fs::canonical(job.folder, code);
    if (!is_inside(place, folder))
        throw Error(ErrorKind::bad_input, {"a symbolic link leads out of the job", file.string(),
                                           "put a file or folder in the place of the link"});
    const fs::file_status target = fs::status(place, code);
    if (fs::exists(target) && !fs::is_regular_file(target) && !fs::is_directory(target))
        throw Error(ErrorKind::bad_input, {"is a device, a pipe or the like", file.string(),
                                           "a job folder holds files and folders: remove it"});
}

std::unique_ptr<std::istream> open_job_file(const FarmJob& job, const fs::path& file) {
    check_job_file(job, file);
    auto stream = std::make_unique<std::ifstream>(file, std::ios::binary);
    return stream->is_open() ? std::move(stream) : nullptr;
}

void make_job_folder(const FarmJob& job, const fs::path& folder) {
    check_job_file(job, folder.parent_path());
    make_job_folder(folder);
    check_job_file(job, folder);
}

} // namespace relief::cli
