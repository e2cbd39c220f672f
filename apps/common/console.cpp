#include "common/console.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "relief/error.h"

namespace relief {

namespace {

std::atomic<int> lost_output_error{0}; ///< errno of the first write to standard output that failed

void note_lost_output(bool is_written) {
    if (!is_written && lost_output_error == 0) lost_output_error = errno != 0 ? errno : EIO;
}

} // namespace

void open_console() {
    for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor) {
        if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free number is this one. Opened against its use, so that a write fails and is noticed.
        if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) != descriptor) return;
    }
    std::signal(SIGPIPE, SIG_IGN);
}

void write_output(std::string_view text) {
    errno = 0;
    note_lost_output(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void write_error(std::string_view text) {
    [[maybe_unused]] const size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

bool flush_output() {
    errno = 0;
    note_lost_output(std::fflush(stdout) == 0);
    return lost_output_error == 0;
}

int close_console(int exit_code) {
    if (flush_output()) return exit_code;
    if (lost_output_error != EPIPE)
        print_error(
            "relief: error: standard output cannot be written: {}\n"
            "hint: only printed lines are lost; an error that concerns a file has a message of its own\n",
            std::strerror(lost_output_error));
    return exit_code == 0 ? int(ErrorKind::failed) : exit_code;
}

} // namespace relief
