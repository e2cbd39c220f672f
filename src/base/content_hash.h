// A stable 64-bit hash of content; not for security.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace relief {

/// XXH3 (Collet, xxHash 0.8) of each part, seeded with the hash of all parts before. Depends on the machine's
/// byte order only. Parts must have no padding.
class ContentHash {
  public:
    /// Continues from the value of another hash.
    explicit ContentHash(uint64_t seed = 0) : state_(seed) {}

    void add_bytes(const void* data, size_t size);
    void add(std::string_view text) { add_bytes(text.data(), text.size()); }
    template <class T> void add(const std::vector<T>& values) {
        add_bytes(values.data(), values.size() * sizeof(T));
    }
    template <size_t N> void add(const std::array<uint32_t, N>& values) {
        add_bytes(values.data(), sizeof values);
    }
    uint64_t value() const { return state_; }

  private:
    uint64_t state_;
};

} // namespace relief
