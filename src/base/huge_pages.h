// Memory for large arrays with random access: requests huge pages, which reduces TLB misses.
#pragma once

#include <cstddef>

namespace relief {

/// `alignment` is a power of two. Throws std::bad_alloc. Free with free_pages.
void* allocate_pages(size_t bytes, size_t alignment);
void free_pages(void* memory);

/// Allocator for std::vector.
template <class T> struct HugePageAllocator {
    using value_type = T;

    HugePageAllocator() = default;
    template <class U> HugePageAllocator(const HugePageAllocator<U>&) {}
    T* allocate(size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T), alignof(T))); }
    void deallocate(T* memory, size_t) { free_pages(memory); }
    friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

} // namespace relief
