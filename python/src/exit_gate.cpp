#include "exit_gate.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <nanobind/nanobind.h>
#include <pthread.h>

#include "relief/error.h"

namespace relief::python {

namespace {

/// Never destroyed: threads sleep in it when the process ends.
struct Gate {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_closing = false;
    std::thread::id closer;
    int visits = 0; ///< threads that are in one
};

thread_local int depth = 0; ///< visits of this thread, each within the one before

/// Threads do not follow into a child process, and neither does the one that may hold the mutex.
Gate* make_gate() {
    Gate* const gate = new Gate;
    gate->visits = depth > 0 ? 1 : 0;
    return gate;
}

std::atomic<Gate*> current_gate{nullptr};

void replace_gate() { current_gate = make_gate(); }

Gate& get_gate() {
    static const bool is_there = [] {
        replace_gate();
        return pthread_atfork(nullptr, nullptr, replace_gate) == 0;
    }();
    static_cast<void>(is_there);
    return *current_gate;
}

[[noreturn]] void refuse() { throw Error(ErrorKind::failed, {"Python is ending", "", ""}); }

/// To the thread that ends it, for good.
void leave_python() { PyEval_SaveThread(); }

[[noreturn]] void sleep_until_the_end() {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

} // namespace

GateVisit::GateVisit() {
    Gate& gate = get_gate();
    std::unique_lock lock(gate.mutex);
    if (gate.is_closing) {
        // Within another visit, which the end waits for, Python is still there: so it is for its own thread.
        if (depth > 0 || gate.closer == std::this_thread::get_id()) refuse();
        lock.unlock();
        leave_python();
        sleep_until_the_end();
    }
    if (depth++ == 0) ++gate.visits;
}

GateVisit::~GateVisit() {
    if (--depth > 0) return;
    Gate& gate = get_gate();
    {
        const std::lock_guard lock(gate.mutex);
        if (!gate.is_closing) {
            --gate.visits;
            return;
        }
    }
    leave_python();
    {
        const std::lock_guard lock(gate.mutex);
        --gate.visits;
    }
    gate.changed.notify_all();
    sleep_until_the_end();
}

bool is_gate_closing() {
    Gate& gate = get_gate();
    const std::lock_guard lock(gate.mutex);
    return gate.is_closing;
}

void close_gate() {
    Gate& gate = get_gate();
    {
        const std::lock_guard lock(gate.mutex);
        gate.is_closing = true, gate.closer = std::this_thread::get_id();
    }
    const nanobind::gil_scoped_release release;
    std::unique_lock lock(gate.mutex);
    // Not wait(): a symbol of GCC 12, which manylinux_2_34 lacks.
    while (!gate.changed.wait_for(lock, std::chrono::hours(1), [&] { return gate.visits == 0; })) {
    }
}

} // namespace relief::python
