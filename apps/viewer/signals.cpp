#include "viewer/signals.h"

#include <csignal>

namespace relief::viewer {

namespace {

volatile std::sig_atomic_t received_signal = 0;

void note(int signal) {
    received_signal = signal;
    std::signal(signal, SIG_DFL);
}

} // namespace

void note_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int get_signal() { return received_signal; }

} // namespace relief::viewer
