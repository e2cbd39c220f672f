// Large pages of memory: reads in no order then miss the table of pages less often, and fewer pages are
// faulted in.
#pragma once

#include <cstddef>

namespace relief {

/// Asks the system for large pages where `memory`, fresh from malloc, lies. Advice only: it may be without
/// effect, and what else lies in those pages keeps its contents. Thread safe.
void advise_large_pages(void* memory, size_t bytes);

} // namespace relief
