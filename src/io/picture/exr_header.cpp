#include "io/picture/exr_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <OpenEXR/ImfCompression.h>

#include "io/picture/color_space.h"
#include "relief/image.h"

namespace relief {

namespace {

constexpr uint32_t kMagic = 0x01312f76, kMultipartFlag = 0x1000;
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
    std::string name, type;
    uint32_t bytes = 0; ///< of its value, where the stream now is
};

/// The word of version and flags; nothing where this is no EXR.
std::optional<uint32_t> read_start(std::istream& stream) {
    if (read_uint32(stream) != kMagic) return std::nullopt;
    return read_uint32(stream);
}

/// Nothing at the end of the header, or where it is cut.
std::optional<Attribute> read_attribute(std::istream& stream) {
    const std::optional<std::string> name = read_name(stream);
    if (!name || name->empty()) return std::nullopt;
    const std::optional<std::string> type = read_name(stream);
    const std::optional<uint32_t> bytes = read_uint32(stream);
    if (!type || !bytes) return std::nullopt;
    return Attribute{*name, *type, *bytes};
}

/// Whether the eight numbers of an attribute of chromaticities are those of Rec.709, to three decimals. A cut
/// attribute counts as such.
bool is_rec709(std::istream& stream) {
    constexpr float kRounding = 1e-3f;
    const Chromaticities c = find_chromaticities("linear");
    for (const float expected :
         {c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y}) {
        const std::optional<uint32_t> bits = read_uint32(stream);
        if (!bits) return true;
        if (!(std::fabs(std::bit_cast<float>(*bits) - expected) <= kRounding)) return false;
    }
    return true;
}

/// Types whose values have one size (OpenEXR file layout, 2023, "Attribute types").
constexpr std::array<std::pair<std::string_view, uint32_t>, 24> kSizes{{{"box2f", 16},
                                                                        {"box2i", 16},
                                                                        {"chromaticities", 32},
                                                                        {"compression", 1},
                                                                        {"deepImageState", 1},
                                                                        {"double", 8},
                                                                        {"envmap", 1},
                                                                        {"float", 4},
                                                                        {"int", 4},
                                                                        {"keycode", 28},
                                                                        {"lineOrder", 1},
                                                                        {"m33d", 72},
                                                                        {"m33f", 36},
                                                                        {"m44d", 128},
                                                                        {"m44f", 64},
                                                                        {"rational", 8},
                                                                        {"tiledesc", 9},
                                                                        {"timecode", 8},
                                                                        {"v2d", 16},
                                                                        {"v2f", 8},
                                                                        {"v2i", 8},
                                                                        {"v3d", 24},
                                                                        {"v3f", 12},
                                                                        {"v3i", 12}}};

/// What a list of channels takes: names, each with 16 bytes, up to an empty one.
uint64_t measure_channels(std::istream& stream, uint64_t limit) {
    constexpr uint64_t kChannelBytes = 16;
    uint64_t bytes = 0;
    while (bytes <= limit) {
        const std::optional<std::string> name = read_name(stream);
        if (!name) break;
        bytes += name->size() + 1;
        if (name->empty()) return bytes;
        bytes += kChannelBytes;
        stream.seekg(std::streamoff(kChannelBytes), std::ios::cur);
    }
    return limit + 1;
}

/// What a list of texts takes that fills `limit` bytes, each with its length before it.
uint64_t measure_texts(std::istream& stream, uint64_t limit) {
    uint64_t bytes = 0;
    while (bytes < limit) {
        const std::optional<uint32_t> length = read_uint32(stream);
        if (!length) return limit + 1;
        bytes += 4 + uint64_t(*length);
        stream.seekg(std::streamoff(*length), std::ios::cur);
    }
    return bytes;
}

uint64_t measure_preview(std::istream& stream, uint64_t limit) {
    constexpr uint32_t kLargestSide = 0xffff;
    const std::optional<uint32_t> width = read_uint32(stream), height = read_uint32(stream);
    if (!width || !height || *width > kLargestSide || *height > kLargestSide) return limit + 1;
    return 8 + 4 * uint64_t(*width) * *height;
}

/// What OpenEXR will read of the value, where the stream is. It goes by the size itself for all other types.
uint64_t measure_value(std::istream& stream, const Attribute& attribute) {
    const auto* fixed = std::find_if(kSizes.begin(), kSizes.end(),
                                     [&](const auto& entry) { return entry.first == attribute.type; });
    if (fixed != kSizes.end()) return fixed->second;
    if (attribute.type == "chlist") return measure_channels(stream, attribute.bytes);
    if (attribute.type == "stringvector") return measure_texts(stream, attribute.bytes);
    if (attribute.type == "preview") return measure_preview(stream, attribute.bytes);
    if (attribute.type == "floatvector") return attribute.bytes / 4 * 4;
    return attribute.bytes;
}

/// In the header where the stream is; else the stream is at its end.
std::optional<std::string> find_missized_attribute(std::istream& stream, uint64_t stream_bytes) {
    while (const std::optional<Attribute> attribute = read_attribute(stream)) {
        const std::streamoff start = stream.tellg();
        if (uint64_t(start) + attribute->bytes > stream_bytes) return attribute->name;
        if (measure_value(stream, *attribute) != attribute->bytes) return attribute->name;
        stream.clear();
        stream.seekg(start + std::streamoff(attribute->bytes));
    }
    return std::nullopt;
}

} // namespace

std::optional<std::string> find_missized_exr_attribute(std::istream& stream, uint64_t stream_bytes) {
    const std::optional<uint32_t> flags = read_start(stream);
    if (!flags) return std::nullopt;
    while (true) {
        if (auto name = find_missized_attribute(stream, stream_bytes)) return name;
        // Headers of parts follow one another, up to an empty one.
        if ((*flags & kMultipartFlag) == 0 || !stream || stream.peek() <= 0) return std::nullopt;
    }
}

std::string find_exr_color_tag(std::istream& stream) {
    if (!read_start(stream)) return {};
    while (const std::optional<Attribute> attribute = read_attribute(stream)) {
        if (attribute->name == "chromaticities")
            return is_rec709(stream) ? "attribute chromaticities" : kOtherPrimariesTag;
        if (attribute->name == kRenderedTag) return kRenderedTag;
        stream.seekg(std::streamoff(attribute->bytes), std::ios::cur);
    }
    return {};
}

std::string find_unknown_exr_compression(std::istream& stream) {
    // OpenEXR 3.4: ImfCompression.h; later ones by the numbers that their writers give them.
    constexpr int kKnown = Imf::NUM_COMPRESSION_METHODS;
    constexpr std::array<std::pair<int, const char*>, 4> kNames{
        {{10, "HTJ2K"}, {11, "HTJ2K"}, {12, "JPEG 2000"}, {13, "Zstandard"}}};
    const std::optional<uint32_t> flags = read_start(stream);
    if (!flags) return {};
    bool is_any = true;
    while (is_any) {
        is_any = false;
        while (const std::optional<Attribute> attribute = read_attribute(stream)) {
            is_any = true;
            const std::streamoff start = stream.tellg();
            const int value = attribute->type == "compression" ? stream.get() : 0;
            if (value >= kKnown) {
                const auto found = std::ranges::find(kNames, value, &std::pair<int, const char*>::first);
                return found == kNames.end() ? "number " + std::to_string(value) : found->second;
            }
            stream.clear();
            stream.seekg(start + std::streamoff(attribute->bytes));
        }
        if ((*flags & kMultipartFlag) == 0) break;
    }
    return {};
}

bool is_exr_cube(std::istream& stream) {
    constexpr int kCube = 1;
    if (!read_start(stream)) return false;
    while (const std::optional<Attribute> attribute = read_attribute(stream)) {
        if (attribute->type == "envmap") return stream.get() == kCube;
        stream.seekg(std::streamoff(attribute->bytes), std::ios::cur);
    }
    return false;
}

} // namespace relief
