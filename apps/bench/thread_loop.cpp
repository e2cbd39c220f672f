#include "bench/thread_loop.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace relief::bench {

void run_in_ranges(int threads, size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    std::atomic<size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (size_t begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain))
                body(begin, std::min(begin + grain, count));
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        for (int k = 1; k < threads; ++k) others.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

} // namespace relief::bench
