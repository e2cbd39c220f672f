#include "io/picture/exr_threads.h"

#include <mutex>

#include <OpenEXR/ImfThreading.h>

#include "base/parallel.h"
#include "relief/io.h"

// OpenEXR's pool is not instrumented, so the thread sanitizer would report races: no threads there.
#if defined(__SANITIZE_THREAD__)
#define RELIEF_EXR_WITHOUT_POOL
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RELIEF_EXR_WITHOUT_POOL
#endif
#endif

namespace relief {

void with_io_threads(int threads, const std::function<void()>& body) { with_threads(threads, body); }

int prepare_exr_threads() {
#ifdef RELIEF_EXR_WITHOUT_POOL
    return 0;
#else
    const int threads = thread_count();
    if (threads <= 1) return 0;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(threads);
    // A file has twice as many blocks under way as threads that it is told of; the pool bounds them as well.
    return Imf::globalThreadCount() <= threads ? threads : threads / 2;
#endif
}

} // namespace relief
