// A stable 64-bit fingerprint of content.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// FNV-1a (Fowler, Noll, Vo) over 8-byte words with a final fold of each step; not for security.
class ContentHash {
  public:
    void add_bytes(const void* data, size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        add_word(size);
        for (; size >= 8; bytes += 8, size -= 8) {
            uint64_t word;
            std::memcpy(&word, bytes, 8);
            add_word(word);
        }
        uint64_t rest = 0;
        if (size > 0) std::memcpy(&rest, bytes, size);
        add_word(rest);
    }
    void add(std::string_view text) { add_bytes(text.data(), text.size()); }
    template <class T> void add(const std::vector<T>& values) {
        add_bytes(values.data(), values.size() * sizeof(T));
    }
    template <size_t N> void add(const std::array<uint32_t, N>& values) {
        add_bytes(values.data(), sizeof values);
    }
    uint64_t value() const { return state_; }

  private:
    void add_word(uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3u;
        state_ ^= state_ >> 32;
    }
    uint64_t state_ = 0xcbf29ce484222325u;
};

/// Adds the meshes, the numbers of map tiles, and the size and texels of every texture of a scene once.
void add_scene_content(ContentHash& hash, const Scene& scene);

} // namespace relief
