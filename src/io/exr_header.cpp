#include "io/exr_header.h"

#include <array>
#include <cstdint>

namespace relief {

namespace {

constexpr std::array<unsigned char, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
constexpr size_t kLongestName = 255;

std::optional<uint32_t> read_uint32(std::istream& stream) {
    std::array<unsigned char, 4> bytes{};
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), 4)) return std::nullopt;
    return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8 | uint32_t(bytes[2]) << 16 | uint32_t(bytes[3]) << 24;
}

/// Up to the next zero byte; nothing when the stream ends first or the name is too long.
std::optional<std::string> read_name(std::istream& stream) {
    std::string name;
    for (int byte = stream.get(); byte != 0; byte = stream.get()) {
        if (byte == std::istream::traits_type::eof() || name.size() == kLongestName) return std::nullopt;
        name.push_back(char(byte));
    }
    return name;
}

} // namespace

std::optional<std::string> find_oversized_exr_attribute(std::istream& stream, uint64_t stream_bytes) {
    std::array<unsigned char, 8> head{};
    if (!stream.read(reinterpret_cast<char*>(head.data()), 8)) return std::nullopt;
    for (size_t k = 0; k < kMagic.size(); ++k)
        if (head[k] != kMagic[k]) return std::nullopt;
    while (true) {
        const std::optional<std::string> name = read_name(stream);
        if (!name || name->empty()) return std::nullopt;
        const std::optional<std::string> type = read_name(stream);
        const std::optional<uint32_t> size = read_uint32(stream);
        if (!type || !size) return std::nullopt;
        const uint64_t position = uint64_t(stream.tellg());
        if (position + *size > stream_bytes) return name;
        stream.seekg(std::streamoff(*size), std::ios::cur);
    }
}

} // namespace relief
