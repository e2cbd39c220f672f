#include "io/file_system.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

/// What the suffix promises.
const char* name_kind(const fs::path& file) {
    if (is_mesh_file(file)) return "mesh";
    if (is_picture_name(file)) return "map or picture";
    return get_lower_extension(file) == ".json" ? "scene file" : "file";
}

/// Whether a part of a path is the letter of a drive: "C:/maps/a.exr", which a scene file may hold.
bool find_drive(std::string_view path) {
    const size_t colon = path.find(":/");
    const auto is_letter = [&](size_t k) { return std::isalpha(static_cast<unsigned char>(path[k])) != 0; };
    return colon != std::string_view::npos && colon > 0 && is_letter(colon - 1) &&
           (colon == 1 || path[colon - 2] == '/');
}

bool is_number(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// Frames that a name may stand for: "shot.0001.exr" for "shot.exr" and for "shot.####.exr". Empty: none.
std::string suggest_frames(const fs::path& file, const std::vector<std::string>& names) {
    const std::string name = file.filename().string();
    const size_t first = name.find("##"), last = name.find_last_of('#');
    const bool is_pattern = first != std::string::npos;
    const std::string before = is_pattern ? name.substr(0, first) : file.stem().string() + ".";
    const std::string after = is_pattern ? name.substr(last + 1) : file.extension().string();
    std::vector<std::string_view> frames;
    for (const std::string_view other : names)
        if (other.size() > before.size() + after.size() && other.starts_with(before) &&
            other.ends_with(after) &&
            is_number(other.substr(before.size(), other.size() - before.size() - after.size())))
            frames.push_back(other);
    if (frames.empty()) return {};
    return frames.size() == 1 ? fmt::format("did you mean '{}'?", frames.front())
                              : fmt::format("did you mean one of its {} frames, from '{}' to '{}'?",
                                            frames.size(), frames.front(), frames.back());
}

std::string suggest_file(const fs::path& file) {
    if (file.filename().string().find('*') != std::string::npos) return "no file has a name of this pattern";
    const std::string text = file.string();
    if (find_drive(text))
        return "it is on a drive of Windows: write its path relative to the scene file, with /";
    std::error_code code;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, code))
        return fmt::format("the folder '{}' does not exist", folder.string());
    constexpr size_t kMostNames = 1000;
    std::vector<std::string> names;
    for (fs::directory_iterator it(folder, code), end; !code && it != end && names.size() < kMostNames;
         it.increment(code))
        if (it->is_regular_file(code)) names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    if (const std::string frames = suggest_frames(file, names); !frames.empty()) return frames;
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string hint = suggest_word(file.filename().string(), views);
    if (hint.starts_with("did")) return hint;
    return fmt::format("check the name: no {} of a similar name is in the folder '{}'", name_kind(file),
                       folder.string());
}

/// What a new file must not take the place of: /dev/null, say, or /dev/stdout, which may stand for a file.
bool is_special(const fs::path& target) {
    std::error_code code;
    const fs::file_status status = fs::status(target, code);
    if (fs::exists(status) && !fs::is_regular_file(status)) return true;
    const fs::path folder = fs::weakly_canonical(target.has_parent_path() ? target.parent_path() : ".", code);
    return folder == "/dev" || folder.native().starts_with("/proc/");
}

const char* const kLoop = "is a symbolic link, or in one, that leads back to itself";
const char* const kLoopHint = "readlink -f shows where links end: name the file itself, or link to it again";

bool is_loop(const std::error_code& code) { return code == std::errc::too_many_symbolic_link_levels; }

} // namespace

fs::path find_link_end(fs::path file) {
    constexpr int kMostLinks = 40; // as of Linux
    std::error_code code;
    for (int k = 0; k < kMostLinks && fs::is_symlink(file, code); ++k) {
        const fs::path next = fs::read_symlink(file, code);
        if (code) break;
        file = next.is_absolute() ? next : file.parent_path() / next;
    }
    return file;
}

std::string get_lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

fs::path find_with_slashes(const fs::path& file) {
    std::string text = file.string();
    std::error_code code;
    if (text.find('\\') == std::string::npos || fs::exists(file, code)) return file;
    std::replace(text.begin(), text.end(), '\\', '/');
    return text;
}

void require_file(const fs::path& file) {
    std::error_code code;
    const fs::file_status status = fs::status(file, code);
    if (is_loop(code)) throw Error(ErrorKind::bad_input, {kLoop, file.string(), kLoopHint});
    if (!fs::exists(status))
        throw Error(ErrorKind::bad_input, {"file not found", file.string(), suggest_file(file)});
    if (!fs::is_regular_file(status))
        throw Error(ErrorKind::bad_input, {"not a regular file", file.string(), "give the name of a file"});
    if (::access(file.c_str(), R_OK) != 0)
        throw Error(ErrorKind::bad_input, {fmt::format("cannot be read: {}", std::strerror(errno)),
                                           file.string(), "check its rights"});
}

std::string read_file_bytes(const fs::path& file) {
    require_file(file);
    std::ifstream stream(file, std::ios::binary);
    std::string bytes;
    try {
        bytes.resize(size_t(fs::file_size(file)));
    } catch (const std::exception& error) {
        throw Error(ErrorKind::bad_input,
                    {fmt::format("cannot be read: {}", error.what()), file.string(), ""});
    }
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    if (!stream || size_t(stream.gcount()) != bytes.size())
        throw Error(ErrorKind::bad_input, {"cannot be read to its end", file.string(), "check the disk"});
    return bytes;
}

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
    std::error_code code;
    place_ = find_link_end(target_); // the link stays
    temporary_ = place_;
    temporary_ += fmt::format(".{}.tmp", ::getpid());
    const fs::path folder = place_.has_parent_path() ? place_.parent_path() : fs::path(".");
    [[maybe_unused]] const fs::file_status status = fs::status(target_, code);
    if (is_loop(code)) throw Error(ErrorKind::failed, {kLoop, target_.string(), kLoopHint});
    if (!target_.has_filename() || fs::is_directory(target_, code))
        throw Error(ErrorKind::failed, {"is a folder, not a file", target_.string(), "add a file name"});
    if (!fs::is_directory(folder, code))
        throw Error(ErrorKind::failed, {fmt::format("the folder '{}' does not exist", folder.string()),
                                        target_.string(), "make the folder first"});
    if (is_special(target_))
        throw Error(ErrorKind::failed, {"is a device, a pipe or the like, not a regular file",
                                        target_.string(), "write to a file and pass that on"});
}

AtomicFile::~AtomicFile() {
    std::error_code code;
    if (!is_committed_) fs::remove(temporary_, code);
}

void AtomicFile::fail(const std::string& message) const {
    throw Error(ErrorKind::failed,
                {message, target_.string(), "check free space and rights, or write to another place"});
}

void AtomicFile::commit() {
    std::error_code code;
    const auto size = fs::file_size(temporary_, code);
    if (code || size == 0) fail("cannot be written: nothing reached the disk");
    fs::rename(temporary_, place_, code);
    if (code) fail("cannot be put in place: " + code.message());
    is_committed_ = true;
}

void check_text_writable(const fs::path& file) {
    const AtomicFile atomic(file);
    const std::ofstream probe(atomic.temporary(), std::ios::binary);
    if (!probe) atomic.fail("cannot be written: no file can be made in its folder");
}

void write_file(const fs::path& file, const std::function<void(std::ostream&)>& write) {
    AtomicFile atomic(file);
    std::ofstream stream(atomic.temporary(), std::ios::binary);
    errno = 0;
    if (stream) write(stream);
    if (!stream.flush())
        atomic.fail(fmt::format("cannot be written: {}", std::strerror(errno ? errno : EIO)));
    stream.close();
    atomic.commit();
}

void write_text_file(const fs::path& file, std::string_view text) {
    write_file(file, [&](std::ostream& stream) { stream.write(text.data(), std::streamsize(text.size())); });
}

} // namespace relief
