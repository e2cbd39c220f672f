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

struct Attribute {
    std::string name;
    uint32_t bytes = 0; ///< of its value, where the stream now is
};

bool skip_start(std::istream& stream) {
    std::array<unsigned char, 8> head{};
    if (!stream.read(reinterpret_cast<char*>(head.data()), 8)) return false;
    for (size_t k = 0; k < kMagic.size(); ++k)
        if (head[k] != kMagic[k]) return false;
    return true;
}

/// Nothing at the end of the header, or where it is cut.
std::optional<Attribute> read_attribute(std::istream& stream) {
    const std::optional<std::string> name = read_name(stream);
    if (!name || name->empty()) return std::nullopt;
    const std::optional<std::string> type = read_name(stream);
    const std::optional<uint32_t> bytes = read_uint32(stream);
    if (!type || !bytes) return std::nullopt;
    return Attribute{*name, *bytes};
}

} // namespace

std::optional<std::string> find_oversized_exr_attribute(std::istream& stream, uint64_t stream_bytes) {
    if (!skip_start(stream)) return std::nullopt;
    while (const std::optional<Attribute> attribute = read_attribute(stream)) {
        if (uint64_t(stream.tellg()) + attribute->bytes > stream_bytes) return attribute->name;
        stream.seekg(std::streamoff(attribute->bytes), std::ios::cur);
    }
    return std::nullopt;
}

std::string find_exr_colour_tag(std::istream& stream) {
    if (!skip_start(stream)) return {};
    while (const std::optional<Attribute> attribute = read_attribute(stream)) {
        if (attribute->name == "chromaticities") return "attribute chromaticities";
        stream.seekg(std::streamoff(attribute->bytes), std::ios::cur);
    }
    return {};
}

} // namespace relief
