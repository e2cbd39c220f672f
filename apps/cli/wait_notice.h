// Tells that a render is still preparing, as long as nothing else is told.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "common/progress.h"

namespace relief::cli {

/// Prints `step` and the time since this was made, after `first` and every `next`, until stop().
class WaitNotice {
  public:
    /// `printer` outlives this object and is used by nothing else until stop(), but under interject().
    WaitNotice(ProgressPrinter& printer, std::string step,
               std::chrono::milliseconds first = std::chrono::seconds(1),
               std::chrono::milliseconds next = std::chrono::milliseconds(500));
    ~WaitNotice();
    WaitNotice(const WaitNotice&) = delete;
    WaitNotice& operator=(const WaitNotice&) = delete;

    /// Nothing is printed any more. Thread safe, and may be called again.
    void stop();

    /// Nothing is printed until what this returns is gone, and the line that was being written is ended.
    std::unique_lock<std::mutex> interject();

  private:
    void run();

    ProgressPrinter& printer_;
    const std::string step_;
    const std::chrono::milliseconds first_, next_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_stopped_ = false;
    std::thread thread_;
};

} // namespace relief::cli
