// Parallel loops of the benchmarks: the library's thread pool is internal, and Embree traces on the caller's
// threads.
#pragma once

#include <cstddef>
#include <functional>

namespace relief::bench {

/// Calls `body(begin, end)` for disjoint ranges that cover [0, count), each at most `grain` long, on
/// `threads` threads: the caller's and new ones. The first exception of a body is rethrown at the end.
void run_in_ranges(int threads, size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

} // namespace relief::bench
