#include "interrupt.h"

#include <atomic>
#include <csignal>
#include <unistd.h>

#include "exit_codes.h"

namespace relief::cli {

namespace {

// The one global of the command: a signal handler has no other way to tell.
std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

extern "C" void note_signal(int signal) {
    if (caught_signal.exchange(signal) != 0) _exit(kExitSignalBase + signal);
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

int get_interrupt() { return caught_signal.load(); }

} // namespace relief::cli
