// Tells that a render is still preparing, as long as nothing else is told.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "common/progress.h"

namespace relief::cli {

/// Prints `step` and the time since this was made, from the first second on, until stop().
class WaitNotice {
  public:
    /// `printer` outlives this object and is used by nothing else until stop().
    WaitNotice(ProgressPrinter& printer, std::string step);
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
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_stopped_ = false;
    std::thread thread_;
};

} // namespace relief::cli
