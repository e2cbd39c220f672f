#include "viewer/file_watch.h"

#include <system_error>

namespace relief::viewer {

FileStamp read_stamp(const std::filesystem::path& file) {
    std::error_code code;
    FileStamp stamp;
    if (!std::filesystem::is_regular_file(file, code)) return stamp;
    stamp.time = std::filesystem::last_write_time(file, code);
    stamp.bytes = std::filesystem::file_size(file, code);
    return code ? FileStamp() : stamp;
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
    std::map<std::filesystem::path, Watched> watched;
    for (const std::filesystem::path& file : files) {
        const auto found = files_.find(file);
        const FileStamp stamp = found == files_.end() ? read_stamp(file) : FileStamp();
        watched[file] = found == files_.end() ? Watched{stamp, stamp} : found->second;
    }
    files_ = std::move(watched);
}

void FileWatch::accept(const std::filesystem::path& file) {
    const auto found = files_.find(file);
    if (found == files_.end()) return;
    const FileStamp stamp = read_stamp(file);
    found->second = {stamp, stamp};
}

std::vector<std::filesystem::path> FileWatch::poll() {
    std::vector<std::filesystem::path> changed;
    for (auto& [file, watched] : files_) {
        const FileStamp now = read_stamp(file);
        const bool is_quiet = now == watched.last;
        watched.last = now;
        if (!is_quiet || now == watched.known || now == FileStamp()) continue;
        watched.known = now;
        changed.push_back(file);
    }
    return changed;
}

} // namespace relief::viewer
