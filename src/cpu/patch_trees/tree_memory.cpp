#include "cpu/patch_trees/tree_memory.h"

#include <bit>
#include <new>

#include <sanitizer/asan_interface.h>
#include <sys/mman.h>

namespace relief::cpu {

namespace {

constexpr int kMostLookedAt = 16; ///< blocks of a list that are looked at, since some of them are too small

/// So that address sanitizers see who reads a tree that is gone.
void forbid(void* block, size_t head_bytes, size_t bytes) {
    ASAN_POISON_MEMORY_REGION(static_cast<char*>(block) + head_bytes, bytes - head_bytes);
}

} // namespace

TreeMemory::~TreeMemory() {
    for (const Region& region : regions_) {
        ASAN_UNPOISON_MEMORY_REGION(region.memory, region.bytes);
        munmap(region.memory, region.bytes);
    }
}

bool TreeMemory::add(size_t bytes) {
    bytes = bytes / kUnit * kUnit;
    if (bytes < 3 * sizeof(Head)) return true; // no tree would fit
    const std::lock_guard lock(mutex_);
    regions_.reserve(regions_.size() + 1);
    void* memory =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) return false;
    madvise(memory, bytes, MADV_NOHUGEPAGE); // they bring nothing, and a few trees would take many
    regions_.push_back({memory, bytes});
    // Blocks end before a head that is never free.
    Head* block = new (memory) Head;
    block->bytes = bytes - sizeof(Head);
    Head* end = new (find_next(block)) Head;
    end->bytes = sizeof(Head), end->bytes_before = block->bytes;
    link(block);
    forbid(block, sizeof(Head), block->bytes);
    return true;
}

void* TreeMemory::allocate(size_t bytes) {
    bytes = block_bytes(bytes);
    const std::lock_guard lock(mutex_);
    Head* block = find_free(bytes);
    if (!block) return nullptr;
    unlink(block);
    cut(block, bytes);
    ASAN_UNPOISON_MEMORY_REGION(block + 1, block->bytes - sizeof(Head));
    return block + 1;
}

void TreeMemory::free(std::span<void* const> blocks) {
    const std::lock_guard lock(mutex_);
    for (void* memory : blocks) {
        Head* block = static_cast<Head*>(memory) - 1;
        block->owner.store(kNoOwner, std::memory_order_relaxed);
        forbid(block, sizeof(Head), block->bytes);
        link(join(block));
    }
}

void TreeMemory::set_owner(void* block, uint32_t owner) {
    (static_cast<Head*>(block) - 1)->owner.store(owner, std::memory_order_relaxed);
}

bool TreeMemory::find_owners(void* block, size_t bytes, std::vector<uint32_t>& owners) {
    constexpr int kLongestWay = 256; // blocks
    bytes = block_bytes(bytes);
    const size_t before = owners.size();
    const std::lock_guard lock(mutex_);
    size_t found = 0;
    Head* at = static_cast<Head*>(block) - 1;
    for (int step = 0; step < kLongestWay && found < bytes; ++step, at = find_next(at)) {
        if (at->bytes == sizeof(Head)) break; // the end
        const uint32_t owner = at->owner.load(std::memory_order_relaxed);
        found += at->bytes;
        if (!at->is_free && owner != kNoOwner && owner != kLeaving) owners.push_back(owner);
        if (!at->is_free && owner == kNoOwner) found = 0, owners.resize(before); // nobody gives that back
    }
    if (found < bytes) owners.resize(before);
    return found >= bytes;
}

/// Four lists for each power of two.
size_t TreeMemory::find_list(size_t bytes) {
    const size_t units = bytes / kUnit;
    const int power = std::bit_width(units) - 1;
    return 4 * size_t(power) + (power < 2 ? units << (2 - power) : units >> (power - 2)) % 4;
}

TreeMemory::Head* TreeMemory::find_next(Head* block) {
    return reinterpret_cast<Head*>(reinterpret_cast<char*>(block) + block->bytes);
}

/// The tightest of the first blocks of the list for this size; else one of the next larger size there is.
TreeMemory::Head* TreeMemory::find_free(size_t bytes) const {
    const size_t own = find_list(bytes);
    Head* best = nullptr;
    int looked_at = 0;
    for (Head* block = lists_[own]; block && looked_at < kMostLookedAt; block = block->next, ++looked_at)
        if (block->bytes >= bytes && (!best || block->bytes < best->bytes)) best = block;
    if (best) return best;
    const size_t first = own + 1;
    for (size_t word = first / 64; word < filled_.size(); ++word) {
        const uint64_t bits =
            filled_[word] & (word == first / 64 ? ~uint64_t(0) << first % 64 : ~uint64_t(0));
        if (bits) return lists_[64 * word + size_t(std::countr_zero(bits))];
    }
    return nullptr;
}

void TreeMemory::link(Head* block) {
    const size_t list = find_list(block->bytes);
    block->is_free = true;
    block->previous = nullptr, block->next = lists_[list];
    if (block->next) block->next->previous = block;
    lists_[list] = block;
    filled_[list / 64] |= uint64_t(1) << list % 64;
}

void TreeMemory::unlink(Head* block) {
    const size_t list = find_list(block->bytes);
    block->is_free = false;
    (block->previous ? block->previous->next : lists_[list]) = block->next;
    if (block->next) block->next->previous = block->previous;
    if (!lists_[list]) filled_[list / 64] &= ~(uint64_t(1) << list % 64);
}

/// What `block`, in no list, has beyond `bytes` becomes a free block.
void TreeMemory::cut(Head* block, size_t bytes) {
    const size_t rest = block->bytes - bytes;
    if (rest <= sizeof(Head)) return;
    block->bytes = bytes;
    Head* after = find_next(block);
    ASAN_UNPOISON_MEMORY_REGION(after, sizeof(Head));
    after = new (after) Head;
    after->bytes = rest, after->bytes_before = bytes;
    find_next(after)->bytes_before = rest;
    link(after);
}

/// `block`, in no list, with its free neighbours.
TreeMemory::Head* TreeMemory::join(Head* block) {
    if (Head* after = find_next(block); after->is_free) {
        unlink(after);
        block->bytes += after->bytes;
        forbid(after, 0, sizeof(Head));
    }
    if (block->bytes_before > 0) {
        Head* before = reinterpret_cast<Head*>(reinterpret_cast<char*>(block) - block->bytes_before);
        if (before->is_free) {
            unlink(before);
            before->bytes += block->bytes;
            forbid(block, 0, sizeof(Head));
            block = before;
        }
    }
    find_next(block)->bytes_before = block->bytes;
    return block;
}

} // namespace relief::cpu
