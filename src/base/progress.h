// Parts of a work, and counts of parallel loops, as one progress.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "base/timer.h"
#include "relief/progress.h"

namespace relief {

/// For a part of the work that goes from `from` to `to` of the whole.
ProgressFunction make_part(const ProgressFunction& whole, double from, double to);

/// Counts what is done. Thread safe.
class ProgressCounter {
  public:
    ProgressCounter(ProgressFunction tell, uint64_t total);
    /// Tells at most ten times a second, and at the end.
    void add(uint64_t count);

  private:
    ProgressFunction tell_;
    uint64_t total_;
    std::atomic<uint64_t> done_{0};
    std::mutex mutex_;
    Timer since_last_;
};

} // namespace relief
