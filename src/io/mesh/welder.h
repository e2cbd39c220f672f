// Gives equal values one index: closed meshes that were stored corner by corner become closed again.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "relief/types.h"

namespace relief {

/// Values of N floats each, in the order in which they came first. Refers to the list that it fills.
template <class Value, size_t N> class Welder {
  public:
    explicit Welder(std::vector<Value>& values) : values_(values) {}

    uint32_t add(const Value& value) {
        if (2 * values_.size() >= slots_.size()) grow();
        uint32_t& slot = find_slot(make_key(value));
        if (slot == kNoIndex) {
            slot = uint32_t(values_.size());
            values_.push_back(value);
        }
        return slot;
    }

  private:
    using Key = std::array<uint32_t, N>;

    static Key make_key(const Value& value) {
        const auto components = std::bit_cast<std::array<float, N>>(value);
        Key key;
        for (size_t i = 0; i < N; ++i) key[i] = std::bit_cast<uint32_t>(components[i] + 0.0f); // -0 is 0
        return key;
    }

    /// The slot of the value that is equal, or the free one where it belongs.
    uint32_t& find_slot(const Key& key) {
        uint64_t hash = 0xcbf29ce484222325u;
        for (const uint32_t word : key) hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
        const size_t mask = slots_.size() - 1;
        size_t slot = hash & mask;
        while (slots_[slot] != kNoIndex && make_key(values_[slots_[slot]]) != key) slot = (slot + 1) & mask;
        return slots_[slot];
    }

    void grow() {
        constexpr size_t kFewest = 64;
        slots_.assign(slots_.empty() ? kFewest : 2 * slots_.size(), kNoIndex);
        for (uint32_t i = 0; i < values_.size(); ++i) find_slot(make_key(values_[i])) = i;
    }

    std::vector<Value>& values_;
    std::vector<uint32_t>
        slots_; ///< indices of values, at most half of them taken; their number is a power of 2
};

using PointWelder = Welder<Vec3f, 3>;
using UvWelder = Welder<Vec2f, 2>;

} // namespace relief
