#include "engine/cpu/tree_memory.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>

#include <tbb/scalable_allocator.h>

namespace relief::cpu {

namespace {

constexpr size_t kLargePage = size_t(2) << 20;

/// Whole large pages at an address that is one, for the pool; null where there are none.
void* map_pages(std::intptr_t, size_t& bytes) {
    bytes = (bytes + kLargePage - 1) / kLargePage * kLargePage;
    void* mapped = mmap(nullptr, bytes + kLargePage, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) return nullptr;
    char* const begin = static_cast<char*>(mapped);
    const size_t before = (kLargePage - reinterpret_cast<uintptr_t>(mapped) % kLargePage) % kLargePage;
    if (before > 0) munmap(begin, before);
    if (before < kLargePage) munmap(begin + before + bytes, kLargePage - before);
    // Advice only: small pages do where the system has no large ones.
    madvise(begin + before, bytes, MADV_HUGEPAGE);
    return begin + before;
}

int unmap_pages(std::intptr_t, void* memory, size_t bytes) { return munmap(memory, bytes); }

} // namespace

TreeMemory::TreeMemory() {
#if !defined(RELIEF_SANITIZED)
    const rml::MemPoolPolicy policy(map_pages, unmap_pages, kLargePage);
    if (rml::pool_create_v1(0, &policy, &pool_) != rml::POOL_OK) pool_ = nullptr;
#endif
}

TreeMemory::~TreeMemory() {
    if (pool_) rml::pool_destroy(pool_);
}

void* TreeMemory::allocate(size_t bytes) {
    if (pool_) return rml::pool_aligned_malloc(pool_, bytes, 64);
    return std::aligned_alloc(64, (bytes + 63) / 64 * 64);
}

void TreeMemory::free(void* memory) {
    if (pool_)
        rml::pool_free(pool_, memory);
    else
        std::free(memory);
}

} // namespace relief::cpu
