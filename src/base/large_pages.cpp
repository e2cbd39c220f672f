#include "base/large_pages.h"

#include <sys/mman.h>

#include <array>
#include <cstdint>

namespace relief {

namespace {

constexpr uintptr_t kLargePage = uintptr_t(2) << 20;

} // namespace

void advise_large_pages(void* memory, size_t bytes) {
    // Pages that this thread has asked for lately: a call to the system costs as much as a small tree.
    static thread_local std::array<uintptr_t, 256> asked{};
    const uintptr_t first = reinterpret_cast<uintptr_t>(memory) / kLargePage;
    const uintptr_t last = (reinterpret_cast<uintptr_t>(memory) + bytes - 1) / kLargePage;
    for (uintptr_t page = first; page <= last; ++page) {
        uintptr_t& entry = asked[page % asked.size()];
        if (entry == page) continue;
        entry = page;
        // A part that is not mapped is passed over, with an error that says nothing else.
        madvise(reinterpret_cast<void*>(page * kLargePage), kLargePage, MADV_HUGEPAGE);
    }
}

} // namespace relief
