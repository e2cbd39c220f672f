#include "exit_gate.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <nanobind/nanobind.h>

#include "relief/error.h"

namespace relief::python {

namespace {

/// Never destroyed: threads sleep in it when the process ends.
struct Gate {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_closing = false;
    int visits = 0;
};

Gate& get_gate() {
    static Gate& gate = *new Gate;
    return gate;
}

} // namespace

GateVisit::GateVisit() {
    Gate& gate = get_gate();
    const std::lock_guard lock(gate.mutex);
    if (gate.is_closing) throw Error(ErrorKind::failed, {"Python is ending", "", ""});
    ++gate.visits;
}

GateVisit::~GateVisit() {
    Gate& gate = get_gate();
    {
        const std::lock_guard lock(gate.mutex);
        if (!gate.is_closing) {
            --gate.visits;
            return;
        }
    }
    PyEval_SaveThread();
    {
        const std::lock_guard lock(gate.mutex);
        --gate.visits;
    }
    gate.changed.notify_all();
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
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
        gate.is_closing = true;
    }
    const nanobind::gil_scoped_release release;
    std::unique_lock lock(gate.mutex);
    gate.changed.wait(lock, [&] { return gate.visits == 0; });
}

} // namespace relief::python
