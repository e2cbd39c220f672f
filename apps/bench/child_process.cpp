#include "bench/child_process.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "relief/error.h"

extern char** environ;

namespace relief::bench {

namespace {

using Clock = std::chrono::steady_clock;

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

pid_t start_child(const std::vector<std::string>& words, int output) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    pid_t child = 0;
    const int code = posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
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

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
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

ChildResult run_child(const std::vector<std::string>& words) {
    Pipe pipe(words.at(0));
    const Clock::time_point start = Clock::now();
    const pid_t child = start_child(words, pipe.writer());
    pipe.close_writer();
    ChildResult result;
    result.lines = read_lines(pipe.reader(), start);
    result.exit_code = wait_for(child);
    return result;
}

} // namespace relief::bench
