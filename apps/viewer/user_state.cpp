#include "viewer/user_state.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string_view>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

#include "relief/io.h"

namespace relief::viewer {

namespace {

/// Seconds of work that a crash may cost.
constexpr double kKeepInterval = 30;

/// What the names of kept maps begin with.
constexpr char kPainted[] = "painted-";

/// Whether the process that a name goes on with, "123-", is another viewer that still runs.
bool is_of_another(std::string_view name) {
    pid_t process = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), process);
    return code == std::errc() && process > 0 && process != getpid() &&
           (kill(process, 0) == 0 || errno == EPERM);
}

} // namespace

std::filesystem::path find_state_folder() {
    const char *state = std::getenv("XDG_STATE_HOME"), *home = std::getenv("HOME");
    if (state && std::filesystem::path(state).is_absolute()) return std::filesystem::path(state) / "relief";
    if (home && *home) return std::filesystem::path(home) / ".local/state/relief";
    return {};
}

std::filesystem::path UserState::set_aside(const std::filesystem::path& input, const Displacement& map,
                                           int frame) {
    if (folder_.empty()) return {};
    const std::filesystem::path file = name_aside(input, map, frame);
    for (const MapTile& tile : map.tiles) {
        const std::filesystem::path name = name_tile(file, tile.udim);
        kept_.erase(name), aside_.insert(name);
    }
    writer_.write(file, map);
    return file;
}

void UserState::take_back(const std::filesystem::path& input, const Displacement& map, int frame) {
    const std::filesystem::path pattern = name_aside(input, map, frame);
    for (const MapTile& tile : map.tiles) kept_.insert(name_tile(pattern, tile.udim));
}

std::filesystem::path UserState::name_aside(const std::filesystem::path& input, const Displacement& map,
                                            int frame) const {
    std::string name = fmt::format("{}-frame{}{}", map.name, frame, map.is_udim ? ".<UDIM>" : "");
    std::ranges::replace(name, '/', '_');
    return name_painted(input, name);
}

std::vector<std::filesystem::path> UserState::read_recent() const {
    std::vector<std::filesystem::path> files;
    std::ifstream stream(folder_ / "recent.txt");
    std::error_code ignored;
    for (std::string line; std::getline(stream, line);)
        if (!line.empty() && std::filesystem::exists(line, ignored)) files.emplace_back(line);
    return files;
}

void UserState::add_recent(const std::filesystem::path& file) {
    if (folder_.empty()) return;
    std::error_code ignored;
    const std::filesystem::path whole = std::filesystem::absolute(file, ignored);
    std::vector<std::filesystem::path> files = read_recent();
    std::erase(files, whole);
    files.insert(files.begin(), whole);
    std::string text;
    for (size_t k = 0; k < std::min(files.size(), kMostRecent); ++k) text += files[k].string() + "\n";
    std::filesystem::create_directories(folder_, ignored);
    try {
        write_text_file(folder_ / "recent.txt", text);
    } catch (const std::exception&) { // a full disk is no reason to end
    }
}

std::filesystem::path UserState::name_painted(const std::filesystem::path& input,
                                              const std::string& map) const {
    std::error_code ignored;
    const std::string place = std::filesystem::weakly_canonical(input, ignored).string();
    return folder_ / fmt::format("{}{}-{:016x}-{}-{}.exr", kPainted, input.stem().string(),
                                 std::hash<std::string>()(place), getpid(), map);
}

void UserState::keep_painted(double now, Document& document) {
    if (folder_.empty()) return;
    if (!document.has_painted()) last_write_ = now, last_count_ = document.paint_count();
    if (now - last_write_ < kKeepInterval || last_count_ == document.paint_count()) return;
    if (writer_.is_busy()) return;
    last_write_ = now;
    write_painted(document);
}

void UserState::keep_now(Document& document) {
    if (!folder_.empty() && document.has_painted()) write_painted(document);
    writer_.wait();
    writer_.forget();
    kept_.clear(), aside_.clear();
    last_count_ = 0;
}

void UserState::write_painted(Document& document) {
    last_count_ = document.paint_count();
    const std::shared_ptr<const SharedScene> scene = document.snapshot();
    for (const Displacement& map : scene->scene.displacements) {
        if (!document.has_painted(map.name)) continue;
        std::string name = map.name;
        std::ranges::replace(name, '/', '_');
        const std::filesystem::path pattern =
            name_painted(document.input().file, map.is_udim ? name + ".<UDIM>" : name);
        for (const MapTile& tile : map.tiles) kept_.insert(name_tile(pattern, tile.udim));
        writer_.write(pattern, map);
    }
}

std::vector<std::filesystem::path> UserState::claim_painted(const std::filesystem::path& input) {
    std::vector<std::filesystem::path> found, claimed;
    if (folder_.empty()) return claimed;
    std::string start = name_painted(input, "").stem().string();
    start.resize(start.size() - fmt::format("{}-", getpid()).size());
    std::error_code code;
    for (auto file = std::filesystem::directory_iterator(folder_, code);
         !code && file != std::filesystem::directory_iterator(); file.increment(code)) {
        const std::string name = file->path().filename().string();
        if (name.starts_with(start) && !is_of_another(std::string_view(name).substr(start.size())))
            found.push_back(file->path());
    }
    const int64_t now = std::chrono::system_clock::now().time_since_epoch() / std::chrono::microseconds(1);
    for (const std::filesystem::path& file : found) {
        const std::filesystem::path kept =
            folder_ /
            fmt::format("kept-{}-{}", now, file.filename().string().substr(std::size(kPainted) - 1));
        std::filesystem::rename(file, kept, code);
        claimed.push_back(code ? file : kept);
    }
    return claimed;
}

void UserState::forget_painted() {
    writer_.wait();
    writer_.forget();
    std::error_code ignored;
    for (const std::filesystem::path& file : std::exchange(kept_, {})) std::filesystem::remove(file, ignored);
}

void UserState::discard() {
    kept_.merge(aside_);
    aside_.clear();
    forget_painted();
    last_count_ = 0;
}

} // namespace relief::viewer
