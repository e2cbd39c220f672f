// Gives equal values one index: closed meshes that were stored corner by corner become closed again.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "relief/types.h"

namespace relief {

/// Values of N components each, in the order in which they came first. Refers to the list that it fills.
template <class Value, size_t N> class Welder {
  public:
    explicit Welder(std::vector<Value>& values) : values_(values) {}

    uint32_t add(const Value& value) {
        const std::array<float, N> components = std::bit_cast<std::array<float, N>>(value);
        std::array<uint32_t, N> key;
        for (size_t i = 0; i < N; ++i) key[i] = std::bit_cast<uint32_t>(components[i] + 0.0f); // -0 is 0
        const auto [found, is_new] = indices_.try_emplace(key, uint32_t(values_.size()));
        if (is_new) values_.push_back(value);
        return found->second;
    }

  private:
    struct Hash {
        size_t operator()(const std::array<uint32_t, N>& key) const {
            uint64_t hash = 0xcbf29ce484222325u;
            for (const uint32_t word : key) hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
            return size_t(hash);
        }
    };
    std::vector<Value>& values_;
    std::unordered_map<std::array<uint32_t, N>, uint32_t, Hash> indices_;
};

using PointWelder = Welder<Vec3f, 3>;
using UvWelder = Welder<Vec2f, 2>;

} // namespace relief
