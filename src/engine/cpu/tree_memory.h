// Memory of bottom trees: large pages, so that rays which go from patch to patch do not wait for page tables,
// and one pool, so that trees of different sizes take each other's place.
#pragma once

#include <cstddef>

namespace rml {
class MemoryPool;
}

namespace relief::cpu {

/// Thread safe. What is still allocated goes with the pool.
class TreeMemory {
  public:
    TreeMemory();
    ~TreeMemory();
    TreeMemory(const TreeMemory&) = delete;
    TreeMemory& operator=(const TreeMemory&) = delete;

    /// Aligned to 64 bytes; null where the machine has no more.
    void* allocate(size_t bytes);
    void free(void* memory);

  private:
    rml::MemoryPool* pool_ = nullptr; ///< none: malloc serves
};

} // namespace relief::cpu
