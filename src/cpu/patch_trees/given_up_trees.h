// Which trees a cache had and gave up, to tell a tree that is built again from a new one: a Bloom filter with
// one hash function (Bloom 1970, Space/time trade-offs in hash coding with allowable errors).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace relief::cpu {

/// Thread safe.
class GivenUpTrees {
  public:
    /// `hash`: 64 well mixed bits of a tree's key.
    void add(uint64_t hash) { word(hash).fetch_or(bit(hash), std::memory_order_relaxed); }
    /// May be true for a tree that was not added: with a chance of one in ten after 10^5 trees.
    bool may_contain(uint64_t hash) const {
        return (word(hash).load(std::memory_order_relaxed) & bit(hash)) != 0;
    }

  private:
    static constexpr size_t kWords = size_t(1) << 14;
    static uint64_t bit(uint64_t hash) { return uint64_t(1) << (hash & 63); }
    std::atomic<uint64_t>& word(uint64_t hash) { return words_[hash >> 6 & (kWords - 1)]; }
    const std::atomic<uint64_t>& word(uint64_t hash) const { return words_[hash >> 6 & (kWords - 1)]; }

    std::vector<std::atomic<uint64_t>> words_ = std::vector<std::atomic<uint64_t>>(kWords);
};

} // namespace relief::cpu
