#include "base/huge_pages.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace relief {

namespace {

constexpr size_t kHugePage = size_t(2) << 20;

} // namespace

void* allocate_pages(size_t bytes, size_t alignment) {
    const bool is_large = bytes >= kHugePage;
    const size_t unit = is_large ? kHugePage : std::max(alignment, sizeof(void*));
    const size_t size = (bytes + unit - 1) / unit * unit;
    void* const memory = size < bytes ? nullptr : std::aligned_alloc(unit, std::max(size, unit));
    if (!memory) throw std::bad_alloc();
#ifdef __linux__
    // Only a hint: failure is harmless.
    if (is_large) madvise(memory, size, MADV_HUGEPAGE);
#endif
    return memory;
}

void free_pages(void* memory) { std::free(memory); }

} // namespace relief
