// Named parallel loops. The only user of oneTBB; results never depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace relief {

/// Runs `body(begin, end)` over [0, count) cut into ranges of at most `grain`, on the threads of the
/// enclosing with_threads (or all cores). Rethrows the first exception of a body.
void parallel_for(const char* name, size_t count, size_t grain,
                  const std::function<void(size_t, size_t)>& body);

/// Runs both functions, possibly at the same time.
void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second);

/// Index of the calling worker in [0, thread_count()); unique among concurrently running bodies.
int current_thread_index();

/// Maximum number of threads of a parallel_for in this scope.
int thread_count();

/// Calls `body`; parallel loops inside it use at most `threads` workers; 0 means all cores.
void with_threads(int threads, const std::function<void()>& body);

} // namespace relief
