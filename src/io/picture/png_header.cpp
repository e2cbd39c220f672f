#include "io/picture/png_header.h"

#include <array>
#include <string_view>

#include "relief/image.h"

namespace relief {

namespace {

constexpr uint64_t kChecksumBytes = 4;

bool skip_signature(std::istream& stream) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    std::array<char, 8> head{};
    return stream.read(head.data(), 8) && std::string_view(head.data(), 8) == kSignature;
}

uint64_t read_uint32(const char* bytes) {
    uint64_t value = 0;
    for (size_t k = 0; k < 4; ++k) value = value << 8 | uint8_t(bytes[k]);
    return value;
}

/// gAMA holds 100000 times the exponent; that of values left alone is 1.
bool is_gamma_of_colors(std::istream& stream) {
    constexpr uint64_t kLinear = 100000;
    std::array<char, 4> value{};
    return stream.read(value.data(), 4) && read_uint32(value.data()) != kLinear;
}

} // namespace

bool has_oversized_png_chunk(std::istream& stream, uint64_t stream_bytes) {
    std::array<char, 8> head{};
    if (!skip_signature(stream)) return false;
    uint64_t position = 8;
    while (stream.read(head.data(), 8)) {
        position += 8 + read_uint32(head.data()) + kChecksumBytes;
        if (position > stream_bytes) return true;
        stream.seekg(std::streamoff(position));
    }
    return false;
}

std::string find_png_color_tag(std::istream& stream) {
    std::array<char, 8> head{};
    if (!skip_signature(stream)) return {};
    uint64_t position = 8;
    std::string tag;
    while (stream.read(head.data(), 8)) {
        const std::string_view kind(head.data() + 4, 4);
        if (kind == "IDAT") break; // those chunks stand before the pixels
        if (kind == "sRGB" || kind == "iCCP") return std::string(kind) + " chunk";
        if (kind == "cHRM" && tag.empty()) tag = "cHRM chunk";
        if (kind == "gAMA") tag = is_gamma_of_colors(stream) ? "gAMA chunk" : kLinearTag;
        position += 8 + read_uint32(head.data()) + kChecksumBytes;
        stream.seekg(std::streamoff(position));
    }
    return tag;
}

} // namespace relief
