// Loops over threads of the measurements' own: the library's are its own affair, and Embree's rays come from
// the caller's threads.
#pragma once

#include <cstddef>
#include <functional>

namespace relief::bench {

/// Calls `body(begin, end)` for disjoint ranges that cover [0, count), each at most `grain` long, on
/// `threads` threads: the caller's and new ones. The first exception of a body is thrown again at the end.
void run_in_ranges(int threads, size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

} // namespace relief::bench
