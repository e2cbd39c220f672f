#include "io/png_header.h"

#include <array>
#include <string_view>

namespace relief {

bool has_oversized_png_chunk(std::istream& stream, uint64_t stream_bytes) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    constexpr uint64_t kChecksumBytes = 4;
    std::array<char, 8> head{};
    if (!stream.read(head.data(), 8) || std::string_view(head.data(), 8) != kSignature) return false;
    uint64_t position = 8;
    while (stream.read(head.data(), 8)) {
        uint64_t length = 0;
        for (size_t k = 0; k < 4; ++k) length = length << 8 | uint8_t(head[k]);
        position += 8 + length + kChecksumBytes;
        if (position > stream_bytes) return true;
        stream.seekg(std::streamoff(position));
    }
    return false;
}

} // namespace relief
