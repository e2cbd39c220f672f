#include "base/progress.h"

#include <utility>

namespace relief {

ProgressFunction make_part(const ProgressFunction& whole, double from, double to) {
    if (!whole) return {};
    return [whole, from, to](double fraction) { whole(from + fraction * (to - from)); };
}

ProgressCounter::ProgressCounter(ProgressFunction tell, uint64_t total)
    : tell_(std::move(tell)), total_(total) {}

void ProgressCounter::add(uint64_t count) {
    constexpr double kInterval = 0.1; ///< seconds
    const bool is_last = (done_ += count) >= total_;
    if (!tell_ || total_ == 0) return;
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (is_last && !lock) lock.lock();
    if (!lock || (!is_last && since_last_.seconds() < kInterval)) return;
    since_last_ = {};
    tell_(double(done_) / double(total_));
}

} // namespace relief
