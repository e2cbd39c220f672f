#include "base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/profiling.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/stop_request.h"

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RELIEF_THREAD_SANITIZER
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif
#endif

namespace relief {
namespace {

// Distributions' oneTBB is not instrumented, so the thread sanitizer must be told TBB's guarantees: a loop
// happens after what precedes it and before what follows; its bodies are unordered.
class LoopOrder {
  public:
    LoopOrder() { release(&start_); }
    void enter_body() { acquire(&start_); }
    void leave_body() { release(&end_); }
    void finish() { acquire(&end_); }

  private:
#ifdef RELIEF_THREAD_SANITIZER
    static void acquire(void* address) { __tsan_acquire(address); }
    static void release(void* address) { __tsan_release(address); }
#else
    static void acquire(void*) {}
    static void release(void*) {}
#endif
    char start_ = 0, end_ = 0;
};

class BodyScope {
  public:
    explicit BodyScope(LoopOrder& order) : order_(order) { order_.enter_body(); }
    ~BodyScope() { order_.leave_body(); }

  private:
    LoopOrder& order_;
};

/// Of the StopScope that the calling thread works in; null: none.
thread_local const StopScope::Work* current_work = nullptr;

/// A body runs in the scope of its loop, whatever thread it is on.
class InheritedStop {
  public:
    explicit InheritedStop(const StopScope::Work* of_loop) : before_(std::exchange(current_work, of_loop)) {}
    ~InheritedStop() { current_work = before_; }

  private:
    const StopScope::Work* before_;
};

/// Completes the ordering also when a body throws.
class LoopScope {
  public:
    ~LoopScope() { order.finish(); }
    LoopOrder order;
};

} // namespace

StopScope::StopScope(std::function<bool()> is_asked_for, ProgressFunction progress)
    : work_{std::move(is_asked_for), std::move(progress)}, outer_(std::exchange(current_work, &work_)) {}

StopScope::~StopScope() { current_work = outer_; }

void stop_if_asked() {
    if (current_work && current_work->is_asked_for && current_work->is_asked_for()) throw StopRequest();
}

ProgressFunction find_progress() { return current_work ? current_work->progress : ProgressFunction(); }

void parallel_for(const char* name, size_t count, size_t grain,
                  const std::function<void(size_t, size_t)>& body) {
    DCHECK(name && grain > 0);
    tbb::profiling::event trace(name);
    LoopScope loop;
    grain = std::max<size_t>(grain, 1);
    const StopScope::Work* const work = current_work;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count / grain + (count % grain != 0), 1),
        [&](const tbb::blocked_range<size_t>& range) {
            BodyScope scope(loop.order);
            const InheritedStop stop(work);
            stop_if_asked();
            const size_t begin = range.begin() * grain;
            body(begin, begin + std::min(grain, count - begin));
        },
        tbb::simple_partitioner());
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
    parallel_for("invoke", 2, 1, [&](size_t begin, size_t) { (begin == 0 ? first : second)(); });
}

int current_thread_index() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

int thread_count() { return tbb::this_task_arena::max_concurrency(); }

void with_threads(int threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::info::default_concurrency());
    LoopScope loop;
    const StopScope::Work* const work = current_work;
    arena.execute([&] {
        BodyScope scope(loop.order);
        const InheritedStop stop(work);
        body();
    });
}

} // namespace relief
