// Notices when files change on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace relief::viewer {

/// What tells two states of a file apart; as it is made where there is none.
struct FileStamp {
    std::filesystem::file_time_type time{};
    uint64_t bytes = 0;
    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
FileStamp read_stamp(const std::filesystem::path& file);

class FileWatch {
  public:
    /// Watches these files instead of others: as they are now, or as they were reported last. Those that are
    /// not there yet are reported once they are.
    void watch(const std::vector<std::filesystem::path>& files);
    /// What the program itself wrote is no change.
    void accept(const std::filesystem::path& file);

    /// Files that changed since they were reported last, and stayed as they are between two calls: who writes
    /// one needs longer than a moment. A file that is not there is reported once it is back.
    std::vector<std::filesystem::path> poll();

  private:
    struct Watched {
        FileStamp known, last;
    };

    std::map<std::filesystem::path, Watched> files_;
};

} // namespace relief::viewer
