// What becomes of films that turned out to be damaged, while other machines may be putting good ones in their
// place: by a rename, which nothing here can keep from happening between two steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <sys/types.h>

#include "farm/job.h"

namespace relief::cli {

/// Tells a file from another that took its name later.
struct FileIdentity {
    dev_t device = 0;
    ino_t number = 0;
    int64_t bytes = 0, changed_s = 0, changed_ns = 0;
    bool operator==(const FileIdentity&) const = default;
};

/// nullopt: there is no such file. To be asked for before the file is read: if it is the same afterwards, it
/// is what was read.
std::optional<FileIdentity> identify_file(const std::filesystem::path& file);

/// Renames a file to FILE.corrupt, unless it is gone or another than `read` by now; returns whether it did.
/// Throws Error{failed}.
bool set_aside(const std::filesystem::path& file, const FileIdentity& read);

/// Throws Error{failed} for a film that is there and cannot be opened: that is no damage.
void check_openable(const std::filesystem::path& film);

/// The task is to be rendered again: its film, `read` before, is damaged or missing. Returns false, and
/// changes nothing, where another attempt has put a film there since.
bool declare_corrupt(const FarmJob& job, uint32_t task, const std::optional<FileIdentity>& read);

} // namespace relief::cli
