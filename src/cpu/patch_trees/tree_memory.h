// Memory of a fixed size for patch trees: what is taken from the system is what was asked for, however trees
// of different sizes come and go.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace relief::cpu {

/// Blocks in segregated lists by size, cut from larger ones and joined with free neighbours (boundary tags:
/// Knuth 1973, section 2.5; lists by two levels of size: Masmano et al. 2004). Any thread, at any time.
class TreeMemory {
  public:
    TreeMemory() = default;
    ~TreeMemory(); ///< blocks need not be freed before
    TreeMemory(const TreeMemory&) = delete;
    TreeMemory& operator=(const TreeMemory&) = delete;

    /// Adds `bytes`, of which the system gives pages as they are first written. False: it refuses.
    bool add(size_t bytes);
    /// Aligned to 64 bytes; null where no free block is large enough.
    void* allocate(size_t bytes);
    /// What `allocate` gave, none of it null.
    void free(std::span<void* const> blocks);

    /// What a block of `bytes` takes.
    static constexpr size_t block_bytes(size_t bytes) {
        return sizeof(Head) + (bytes + kUnit - 1) / kUnit * kUnit;
    }

    static constexpr uint32_t kNoOwner = 0xffffffff, kLeaving = 0xfffffffe; ///< kLeaving: will be freed
    /// Whom a block is to be asked back from; kNoOwner at first.
    static void set_owner(void* block, uint32_t owner);
    /// Appends owners of neighbours that would make room for `bytes` if they were free: of `block`, in use,
    /// or of those that follow it in memory. False, with nothing appended, where there are none nearby.
    bool find_owners(void* block, size_t bytes, std::vector<uint32_t>& owners);

  private:
    static constexpr size_t kUnit = 64; ///< sizes of blocks are multiples of it

    /// In front of each block.
    struct alignas(64) Head {
        size_t bytes = 0;        ///< of the block with its head
        size_t bytes_before = 0; ///< of the block before it in memory; 0: there is none
        bool is_free = false;
        std::atomic<uint32_t> owner{kNoOwner};
        Head *next = nullptr, *previous = nullptr; ///< in the list of a free block
    };
    struct Region {
        void* memory;
        size_t bytes;
    };
    static constexpr size_t kListCount = 192;

    static size_t find_list(size_t bytes);
    static Head* find_next(Head* block);
    Head* find_free(size_t bytes) const;
    void link(Head* block);
    void unlink(Head* block);
    void cut(Head* block, size_t bytes);
    Head* join(Head* block);

    std::mutex mutex_;
    std::array<Head*, kListCount> lists_{};
    std::array<uint64_t, kListCount / 64> filled_{}; ///< a bit a list
    std::vector<Region> regions_;
};

} // namespace relief::cpu
