#include "bench/child_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "relief/error.h"

extern char** environ;

namespace relief::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kEndLines = 8; ///< of the output of a program that failed

[[noreturn]] void throw_system_error(const std::string& what, const std::string& program, int code) {
    throw Error(ErrorKind::failed, {what + ": " + std::strerror(code), program, ""});
}

/// A pipe that children do not inherit; closes open ends on destruction.
class Pipe {
  public:
    explicit Pipe(const std::string& program) {
        if (pipe2(ends_, O_CLOEXEC) != 0) throw_system_error("no pipe can be made", program, errno);
    }
    ~Pipe() {
        close(ends_[0]);
        close_writer();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    int reader() const { return ends_[0]; }
    int writer() const { return ends_[1]; }
    void close_writer() {
        if (ends_[1] >= 0) close(ends_[1]);
        ends_[1] = -1;
    }

  private:
    int ends_[2] = {-1, -1};
};

/// As posix_spawn takes them; valid as long as the strings are.
std::vector<char*> list_pointers(const std::vector<std::string>& strings) {
    std::vector<char*> pointers;
    for (const std::string& string : strings) pointers.push_back(const_cast<char*>(string.c_str()));
    pointers.push_back(nullptr);
    return pointers;
}

/// This process's environment with `variables` in it.
std::vector<std::string> make_environment(const std::vector<std::string>& variables) {
    std::vector<std::string> all = variables;
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view text = *entry;
        const std::string_view name = text.substr(0, text.find('=') + 1);
        if (std::ranges::none_of(variables, [&](const std::string& v) { return v.starts_with(name); }))
            all.emplace_back(text);
    }
    return all;
}

pid_t start_child(const std::vector<std::string>& words, const std::vector<std::string>& variables,
                  int output) {
    const std::vector<std::string> environment = make_environment(variables);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    pid_t child = 0;
    const int code = posix_spawn(&child, words[0].c_str(), &actions, nullptr, list_pointers(words).data(),
                                 list_pointers(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) throw_system_error("the program cannot be started", words[0], code);
    return child;
}

/// Reads until the other end is closed.
std::vector<LogLine> read_lines(int input, Clock::time_point start) {
    std::vector<LogLine> lines;
    std::string open_line;
    char bytes[4096];
    for (;;) {
        const ssize_t count = read(input, bytes, sizeof(bytes));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        const double now = std::chrono::duration<double>(Clock::now() - start).count();
        for (const char c : std::string_view(bytes, size_t(count)))
            if (c == '\n')
                lines.push_back({now, std::exchange(open_line, {})});
            else
                open_line += c;
    }
    if (!open_line.empty())
        lines.push_back({std::chrono::duration<double>(Clock::now() - start).count(), open_line});
    return lines;
}

double get_seconds(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

void wait_for(pid_t child, ChildResult& result) {
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    result.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    result.processor_s = get_seconds(usage.ru_utime) + get_seconds(usage.ru_stime);
}

} // namespace

std::optional<std::filesystem::path> find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
        std::error_code ignored;
        if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file;
    }
    return {};
}

ChildResult run_child(const std::vector<std::string>& words, const std::vector<std::string>& variables) {
    Pipe pipe(words.at(0));
    const Clock::time_point start = Clock::now();
    const pid_t child = start_child(words, variables, pipe.writer());
    pipe.close_writer();
    ChildResult result;
    result.lines = read_lines(pipe.reader(), start);
    wait_for(child, result);
    return result;
}

ChildResult run_checked(const std::vector<std::string>& words, const std::vector<std::string>& variables) {
    ChildResult child = run_child(words, variables);
    if (child.exit_code == 0) return child;
    std::string end;
    for (size_t k = child.lines.size() - std::min(child.lines.size(), kEndLines); k < child.lines.size(); ++k)
        end += "\n" + child.lines[k].text;
    throw Error(ErrorKind::failed, {fmt::format("ended with exit code {}:{}", child.exit_code, end),
                                    describe_command(words), ""});
}

std::string describe_command(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

} // namespace relief::bench
