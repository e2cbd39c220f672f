// PNG files put together chunk by chunk, sound or damaged.
#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

namespace relief::test {

inline std::string make_big_endian(uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += char(number >> shift & 0xff);
    return bytes;
}

/// Returns a chunk with its length and checksum (PNG, third edition, 5.3).
inline std::string make_png_chunk(const std::string& kind, const std::string& content) {
    const std::string checked = kind + content;
    const uLong check = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()));
    return make_big_endian(uint32_t(content.size())) + checked + make_big_endian(uint32_t(check));
}

inline std::string deflate_all(const std::string& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::string packed(size, '\0');
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size())),
              Z_OK);
    return packed.substr(0, size);
}

/// Colour types of PNG.
enum class PngColors : char { grey = 0, rgb = 2, palette = 3 };

struct PngPicture {
    uint32_t width = 1, height = 1;
    char bits = 8; ///< per sample
    PngColors kind = PngColors::grey;
    bool is_interlaced = false;
    std::string chunks; ///< between header and pixels
    std::string rows;   ///< each with the byte of its filter in front
};

inline std::string make_png(const PngPicture& picture) {
    const std::string header = make_big_endian(picture.width) + make_big_endian(picture.height) +
                               picture.bits + char(picture.kind) + std::string(2, '\0') +
                               char(picture.is_interlaced ? 1 : 0);
    return "\x89PNG\r\n\x1a\n" + make_png_chunk("IHDR", header) + picture.chunks +
           make_png_chunk("IDAT", deflate_all(picture.rows)) + make_png_chunk("IEND", "");
}

} // namespace relief::test
