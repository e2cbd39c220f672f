#include "farm/damaged_part.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "farm/attempts.h"
#include "relief/error.h"

namespace relief::cli {

namespace fs = std::filesystem;

std::optional<FileIdentity> identify_file(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return FileIdentity{status.st_dev, status.st_ino, int64_t(status.st_size), int64_t(status.st_mtim.tv_sec),
                        int64_t(status.st_mtim.tv_nsec)};
}

bool set_aside(const fs::path& file, const FileIdentity& read) {
    if (identify_file(file) != read) return false;
    const fs::path aside = file.string() + ".corrupt";
    std::error_code code;
    fs::rename(file, aside, code);
    if (code == std::errc::no_such_file_or_directory) return false;
    if (code)
        throw Error(ErrorKind::failed, {"is damaged, and cannot be renamed: " + code.message(), file.string(),
                                        "every machine of the farm needs the right to write there"});
    if (identify_file(aside) == read) return true;
    // It was replaced between the two calls. Where one more has come since, both have the same bits.
    fs::rename(aside, file, code);
    return false;
}

void check_openable(const fs::path& film) {
    const int opened = ::open(film.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (opened >= 0) {
        ::close(opened);
        return;
    }
    if (errno == ENOENT) return;
    throw Error(ErrorKind::failed,
                {fmt::format("a part is there, but cannot be read: {}", std::strerror(errno)), film.string(),
                 "every machine of the farm needs the right to read what the others write"});
}

bool declare_corrupt(const FarmJob& job, uint32_t task, const std::optional<FileIdentity>& read) {
    // Listed first: one that ends from here on has put a film there that nobody has read.
    const std::vector<Attempt> attempts = list_attempts(job, task);
    const fs::path film = get_film_file(job, task);
    const bool is_gone = (read && set_aside(film, *read)) || !identify_file(film);
    if (!is_gone) return false;
    for (const Attempt& attempt : attempts) {
        if (attempt.state != AttemptState::done) continue;
        Attempt corrupt = attempt;
        corrupt.state = AttemptState::corrupt;
        change_attempt(job, attempt, corrupt);
    }
    return true;
}

} // namespace relief::cli
