#include "farm/attempts.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/values.h"
#include "farm/folder_names.h"
#include "farm/job_file.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

constexpr uint32_t kTasksAFolder = 1000;
constexpr size_t kReasonBytes = 1024;   ///< that the file of an attempt has room for
constexpr double kMissedHeartbeats = 6; ///< after so many a running attempt counts as dead

constexpr std::array<std::pair<AttemptState, std::string_view>, 7> kWords{
    {{AttemptState::running, "running"},
     {AttemptState::done, "done"},
     {AttemptState::partial, "partial"},
     {AttemptState::failed, "failed"},
     {AttemptState::lost, "lost"},
     {AttemptState::corrupt, "corrupt"},
     {AttemptState::retried, "retried"}}};

/// The next part of a name; nullopt: there is none.
std::optional<std::string_view> take_part(std::string_view& rest) {
    if (rest.empty()) return std::nullopt;
    const size_t dot = rest.find('.');
    const std::string_view part = rest.substr(0, dot);
    rest = dot == std::string_view::npos ? std::string_view() : rest.substr(dot + 1);
    return part;
}

template <class Number> std::optional<Number> take_number(std::string_view& rest) {
    const std::optional<std::string_view> part = take_part(rest);
    Number number = 0;
    if (!part) return std::nullopt;
    const auto [end, code] = std::from_chars(part->data(), part->data() + part->size(), number);
    return code == std::errc() && end == part->data() + part->size() ? std::optional(number) : std::nullopt;
}

std::string read_host_name() {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
    std::string text = name.data();
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return text.empty() ? "unknown" : text;
}

fs::path get_folder(const FarmJob& job, const char* kind, uint32_t task) {
    return job.folder / kind / fmt::format("{:06}", task / kTasksAFolder);
}

[[noreturn]] void fail(const std::string& message, const fs::path& place) {
    throw Error(
        ErrorKind::failed,
        {message, place.string(), "every machine of the farm needs free space and the right to write there"});
}

/// Makes an empty file.
void touch(const fs::path& file) {
    errno = 0;
    if (!std::ofstream(file, std::ios::app))
        fail(fmt::format("no file can be made: {}", std::strerror(errno ? errno : EIO)), file);
}

double count_seconds(const timespec& time) { return double(time.tv_sec) + 1e-9 * double(time.tv_nsec); }

} // namespace

std::string name_attempt(const Attempt& a) {
    std::string_view word;
    for (const auto& [state, text] : kWords)
        if (state == a.state) word = text;
    std::string name = fmt::format("{}.{}.{}", a.task, a.who, word);
    if (a.state == AttemptState::done || a.state == AttemptState::corrupt)
        name += fmt::format(".{}.{}", a.rays, a.milliseconds);
    if (a.state == AttemptState::failed || a.state == AttemptState::retried)
        name += fmt::format(".{}", a.exit_code);
    return name;
}

std::optional<Attempt> parse_attempt_name(std::string_view name) {
    Attempt a;
    const std::optional<uint32_t> task = take_number<uint32_t>(name);
    const std::optional<std::string_view> who = take_part(name), word = take_part(name);
    if (!task || !who || !word) return std::nullopt;
    a.task = *task, a.who = *who;
    bool is_known = false;
    for (const auto& [state, text] : kWords)
        if (text == *word) a.state = state, is_known = true;
    if (!is_known) return std::nullopt;
    if (a.state == AttemptState::done || a.state == AttemptState::corrupt) {
        const std::optional<uint64_t> rays = take_number<uint64_t>(name), time = take_number<uint64_t>(name);
        if (!rays || !time) return std::nullopt;
        a.rays = *rays, a.milliseconds = *time;
    }
    if (a.state == AttemptState::failed || a.state == AttemptState::retried) {
        const std::optional<int> code = take_number<int>(name);
        if (!code) return std::nullopt;
        a.exit_code = *code;
    }
    return name.empty() ? std::optional(a) : std::nullopt;
}

std::string make_attempt_name() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return fmt::format("{}-{}-{}", read_host_name(), ::getpid(),
                       std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

bool is_process_gone(const Attempt& attempt) {
    const std::vector<std::string> parts = split(attempt.who, '-');
    if (parts.size() != 3 || parts[0] != read_host_name()) return false;
    const int process = std::atoi(parts[1].c_str());
    return process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
}

fs::path get_state_folder(const FarmJob& job, uint32_t task) { return get_folder(job, "state", task); }

fs::path get_attempt_file(const FarmJob& job, const Attempt& attempt) {
    return get_state_folder(job, attempt.task) / name_attempt(attempt);
}

std::string read_reason(const FarmJob& job, const Attempt& attempt) {
    std::string reason;
    try {
        if (const auto stream = open_job_file(job, get_attempt_file(job, attempt)))
            std::getline(*stream, reason);
    } catch (const Error& error) {
        return error.what();
    }
    return reason.find_first_not_of(' ') != std::string::npos
               ? reason
               : "no reason could be written: the disk of the job folder may be full";
}

void begin_attempt(const FarmJob& job, const Attempt& attempt) {
    const fs::path file = get_attempt_file(job, attempt);
    errno = 0;
    std::ofstream stream(file);
    const bool is_made = stream.is_open();
    if (is_made && stream << std::string(kReasonBytes, ' ') << std::flush) return;
    const int code = errno ? errno : EIO;
    if (is_made) {
        Attempt failed = attempt;
        failed.state = AttemptState::failed, failed.exit_code = int(ErrorKind::failed);
        stream.close();
        change_attempt(job, attempt, failed);
    }
    fail(fmt::format("no file can be written in the job folder: {}", std::strerror(code)), file);
}

void write_reason(const FarmJob& job, const Attempt& attempt, const std::string& reason) {
    std::string text = reason.substr(0, reason.find('\n'));
    text.resize(std::min(text.size(), kReasonBytes - 1));
    text += '\n';
    // In place: a file that is made anew gives up its room first.
    std::fstream stream(get_attempt_file(job, attempt), std::ios::in | std::ios::out);
    stream << text << std::flush;
    stream.close();
    if (stream.fail()) return;
    std::error_code ignored;
    fs::resize_file(get_attempt_file(job, attempt), text.size(), ignored);
}

std::vector<Attempt> list_attempts(const FarmJob& job, uint32_t task) {
    std::vector<Attempt> attempts;
    visit_names(get_state_folder(job, task), [&](const char* name) {
        std::optional<Attempt> attempt = parse_attempt_name(name);
        if (attempt && attempt->task == task) attempts.push_back(*std::move(attempt));
    });
    return attempts;
}

void change_attempt(const FarmJob& job, const Attempt& before, const Attempt& after) {
    std::error_code code;
    const fs::path to = get_attempt_file(job, after);
    fs::rename(get_attempt_file(job, before), to, code);
    if (code == std::errc::no_such_file_or_directory) return touch(to);
    if (code) fail("cannot be renamed: " + code.message(), to);
}

void declare_dead(const FarmJob& job, const Attempt& attempt) {
    Attempt lost = attempt;
    lost.state = AttemptState::lost;
    std::error_code code;
    fs::rename(get_attempt_file(job, attempt), get_attempt_file(job, lost), code);
    if (code == std::errc::no_such_file_or_directory) return;
    if (code) fail("cannot be renamed: " + code.message(), get_attempt_file(job, lost));
    const fs::path film = get_attempt_film_file(job, attempt);
    // A hard link fails where there are samples already, so that none are lost.
    if (!fs::exists(get_film_file(job, attempt.task), code))
        fs::create_hard_link(film, get_partial_film_file(job, attempt.task), code);
    fs::remove(film, code);
}

std::optional<double> measure_silence(const FarmJob& job, const Attempt& attempt, double now_s) {
    struct stat status {};
    if (::stat(get_attempt_file(job, attempt).c_str(), &status) != 0) return std::nullopt;
    return now_s - count_seconds(status.st_mtim);
}

double read_storage_clock(const FarmJob& job) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    const fs::path probe = job.folder / "state" / fmt::format("clock-{}", make_attempt_name());
    struct stat status {};
    const bool is_read = std::ofstream(probe).is_open() && ::stat(probe.c_str(), &status) == 0;
    std::error_code code;
    fs::remove(probe, code);
    return count_seconds(is_read ? status.st_mtim : now); // who may only read has but his own clock
}

bool is_stale(const FarmJob& job, const Attempt& attempt, double silence_s) {
    return silence_s > kMissedHeartbeats * job.heartbeat_s || is_process_gone(attempt);
}

fs::path get_film_file(const FarmJob& job, uint32_t task) {
    return get_folder(job, "parts", task) / fmt::format("{}.film", task);
}

fs::path get_partial_film_file(const FarmJob& job, uint32_t task) {
    return get_folder(job, "parts", task) / fmt::format("{}.partial.film", task);
}

fs::path get_attempt_film_file(const FarmJob& job, const Attempt& attempt) {
    return get_folder(job, "parts", attempt.task) / fmt::format("{}.{}.film", attempt.task, attempt.who);
}

fs::path get_preview_file(const FarmJob& job, uint32_t task) {
    return get_folder(job, "previews", task) / fmt::format("{}.exr", task);
}

fs::path get_log_file(const FarmJob& job, uint32_t task) {
    return get_folder(job, "log", task) / fmt::format("{}.txt", task);
}

void make_job_folder(const fs::path& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) fail("the folder cannot be made: " + code.message(), folder);
}

void rename_job_file(const fs::path& from, const fs::path& to) {
    std::error_code code;
    fs::rename(from, to, code);
    if (code) fail("cannot be renamed: " + code.message(), to);
}

} // namespace relief::cli
