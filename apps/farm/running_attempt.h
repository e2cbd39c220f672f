// An attempt of this process at a task: shows that it lives, and in the end how it ended.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "farm/attempts.h"

namespace relief::cli {

class RunningAttempt {
  public:
    /// From now on it counts as running; earlier attempts at the task that are dead become lost. Throws
    /// Error{failed} where the job folder cannot be written.
    RunningAttempt(const FarmJob& job, const FarmTask& task);
    /// One that was not ended failed.
    ~RunningAttempt();
    RunningAttempt(const RunningAttempt&) = delete;
    RunningAttempt& operator=(const RunningAttempt&) = delete;

    /// Where this attempt alone writes its film.
    std::filesystem::path film_file() const;

    /// The film is whole: puts it in its place, which another attempt may have taken with the same bits.
    void end_done(uint64_t rays);
    /// The film has some of the samples, if it is there: the next attempt begins with it.
    void end_partial();
    /// `reason`: one line, kept for `status`.
    void end_failed(int exit_code, const std::string& reason);

  private:
    void beat();
    void stop_beating();
    void end(Attempt after);

    const FarmJob& job_;
    Attempt attempt_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    bool has_ended_ = false;
    std::mutex mutex_;
    std::condition_variable is_over_;
    bool must_stop_ = false;
    std::thread heart_;
};

} // namespace relief::cli
