#include "base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/profiling.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "base/check.h"

namespace relief {

void parallel_for(const char* name, size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    DCHECK(name && grain > 0);
    tbb::profiling::event trace(name);
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
        [&](const tbb::blocked_range<size_t>& range) { body(range.begin(), range.end()); },
        tbb::simple_partitioner());
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
    tbb::parallel_invoke(first, second);
}

int current_thread_index() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

int thread_count() { return tbb::this_task_arena::max_concurrency(); }

void with_threads(int threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::info::default_concurrency());
    arena.execute(body);
}

} // namespace relief
