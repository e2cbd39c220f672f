#include "interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>
#include <sys/time.h>
#include <unistd.h>

#include "common/exit_codes.h"

namespace relief::cli {

namespace {

// The only globals of the command; a signal handler needs them.
std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

std::atomic<bool> is_polled{false}, is_heard{false}, has_picture{false}, is_waiting{false};

std::atomic<int64_t> caught_at{0}; ///< steady clock, milliseconds; 0: no signal yet
static_assert(std::atomic<int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

int64_t get_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return int64_t(now.tv_sec) * 1000 + now.tv_nsec / 1000000;
}

[[noreturn]] void leave(int signal, std::string_view message) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message.data(), message.size());
    _exit(kExitSignalBase + signal);
}

/// A driver that compiles a kernel asks nobody; without a picture there is nothing to wait for.
extern "C" void leave_unless_heard(int) {
    if (!is_heard)
        leave(caught_signal,
              "\nrelief: interrupted before every pixel had a sample; no picture was written\n");
}

void start_patience() {
    constexpr itimerval kPatience{{0, 0}, {0, 150'000}};
    setitimer(ITIMER_REAL, &kPatience, nullptr);
}

/// A quick double stroke counts as one: the picture is written.
extern "C" void note_signal(int signal) {
    constexpr int64_t kTogether = 500;
    if (is_waiting) leave(signal, "\nrelief: interrupted while it waited for edits\n");
    if (!is_polled) leave(signal, "\nrelief: interrupted before the first ray; no picture was written\n");
    const int64_t now = get_milliseconds();
    int64_t first = 0;
    if (caught_at.compare_exchange_strong(first, now)) {
        caught_signal = signal;
        if (!has_picture) start_patience();
    } else if (now - first > kTogether) {
        _exit(kExitSignalBase + signal);
    }
}

} // namespace

void catch_interrupts() {
    is_polled = has_picture = is_waiting = false;
    std::signal(SIGALRM, leave_unless_heard);
    // Signals ignored by the parent, as for background jobs, stay ignored.
    for (const int signal : {SIGINT, SIGTERM})
        if (std::signal(signal, note_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
}

void poll_interrupts() {
    is_polled = true;
    is_waiting = false;
}

void await_input() { is_waiting = true; }

void keep_picture() { has_picture = true; }

int get_interrupt() {
    const int signal = caught_signal;
    if (signal != 0) is_heard = true;
    return signal;
}

} // namespace relief::cli
