#include "wait_notice.h"

#include <utility>

namespace relief::cli {

WaitNotice::WaitNotice(ProgressPrinter& printer, std::string step, std::chrono::milliseconds first,
                       std::chrono::milliseconds next)
    : printer_(printer), step_(std::move(step)), first_(first), next_(next), thread_([this] { run(); }) {}

WaitNotice::~WaitNotice() {
    stop();
    thread_.join();
}

void WaitNotice::stop() {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_one();
}

std::unique_lock<std::mutex> WaitNotice::interject() {
    std::unique_lock lock(mutex_);
    printer_.end_line();
    return lock;
}

void WaitNotice::run() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::unique_lock lock(mutex_);
    for (Clock::time_point next = start + first_;; next += next_) {
        if (changed_.wait_until(lock, next, [this] { return is_stopped_; })) return;
        Progress progress;
        progress.fraction = -1;
        progress.elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
        printer_.print(progress, step_);
    }
}

} // namespace relief::cli
