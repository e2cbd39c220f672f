// PNG, W3C recommendation of 2003: all rows with one filter.
#include <array>
#include <cstdlib>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>

#include <zlib.h>

#include "io/picture/image_coders.h"

namespace relief {

namespace {

void append_uint32(std::vector<uint8_t>& bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(uint8_t(value >> shift));
}

/// Length, kind and content, and the checksum over the last two.
void write_chunk(CheckedFile& file, std::string_view kind, std::span<const uint8_t> content) {
    std::vector<uint8_t> bytes;
    append_uint32(bytes, uint32_t(content.size()));
    bytes.insert(bytes.end(), kind.begin(), kind.end());
    bytes.insert(bytes.end(), content.begin(), content.end());
    append_uint32(bytes, uint32_t(crc32_z(0, bytes.data() + 4, bytes.size() - 4)));
    file.write(bytes.data(), bytes.size());
}

/// Packs bytes into IDAT chunks.
class DataStream {
  public:
    explicit DataStream(CheckedFile& file) : file_(file), packed_(kChunkBytes) {
        const int status = deflateInit(&stream_, Z_DEFAULT_COMPRESSION);
        if (status == Z_MEM_ERROR) throw std::bad_alloc();
        if (status != Z_OK) throw std::runtime_error("zlib failed");
        stream_.next_out = packed_.data(), stream_.avail_out = kChunkBytes;
    }
    ~DataStream() { deflateEnd(&stream_); }
    DataStream(const DataStream&) = delete;
    DataStream& operator=(const DataStream&) = delete;

    void add(std::vector<uint8_t>& bytes) {
        stream_.next_in = bytes.data(), stream_.avail_in = uInt(bytes.size());
        while (stream_.avail_in > 0) run(Z_NO_FLUSH);
    }
    void finish() {
        while (run(Z_FINISH) != Z_STREAM_END) {
        }
        flush();
    }

  private:
    static constexpr uInt kChunkBytes = 1u << 16;

    int run(int mode) {
        if (stream_.avail_out == 0) flush();
        const int status = deflate(&stream_, mode);
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            throw std::runtime_error("zlib failed");
        return status;
    }
    void flush() {
        write_chunk(file_, "IDAT", std::span(packed_).first(kChunkBytes - stream_.avail_out));
        stream_.next_out = packed_.data(), stream_.avail_out = kChunkBytes;
    }

    CheckedFile& file_;
    std::vector<uint8_t> packed_;
    z_stream stream_{};
};

int predict_paeth(int left, int up, int up_left) {
    const int guess = left + up - up_left;
    const int to_left = std::abs(guess - left), to_up = std::abs(guess - up);
    const int to_up_left = std::abs(guess - up_left);
    if (to_left <= to_up && to_left <= to_up_left) return left;
    return to_up <= to_up_left ? up : up_left;
}

/// Type 4, Paeth: rendered pictures change little from pixel to pixel.
void filter_row(const std::vector<uint8_t>& row, const std::vector<uint8_t>& row_above, size_t pixel_bytes,
                std::vector<uint8_t>& filtered) {
    filtered = {4};
    for (size_t x = 0; x < row.size(); ++x) {
        const int left = x >= pixel_bytes ? row[x - pixel_bytes] : 0;
        const int up_left = x >= pixel_bytes ? row_above[x - pixel_bytes] : 0;
        filtered.push_back(uint8_t(row[x] - predict_paeth(left, row_above[x], up_left)));
    }
}

void write_start(CheckedFile& file, int width, int height, uint8_t bits) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    file.write(kSignature.data(), kSignature.size());
    std::vector<uint8_t> header;
    append_uint32(header, uint32_t(width));
    append_uint32(header, uint32_t(height));
    const std::array<uint8_t, 5> kind = {bits, 2, 0, 0, 0}; // colours
    header.insert(header.end(), kind.begin(), kind.end());
    write_chunk(file, "IHDR", header);
}

void write_rows(CheckedFile& file, const Vec2<int>& size, size_t pixel_bytes,
                const FillRow<uint8_t>& fill_row) {
    DataStream data(file);
    std::vector<uint8_t> row(size_t(size.x) * pixel_bytes), row_above(row.size()), filtered;
    for (int y = 0; y < size.y; ++y) {
        fill_row(y, row);
        filter_row(row, row_above, pixel_bytes, filtered);
        data.add(filtered);
        row.swap(row_above);
    }
    data.finish();
    write_chunk(file, "IEND", {});
}

} // namespace

void encode_png(int width, int height, const FillRow<uint8_t>& fill_row, CheckedFile& file) {
    constexpr std::array<uint8_t, 1> kPerceptual = {0};
    write_start(file, width, height, 8);
    write_chunk(file, "sRGB", kPerceptual);
    write_rows(file, {width, height}, 3, fill_row);
}

void encode_png_of_16_bits(int width, int height, const FillRow<uint8_t>& fill_row, CheckedFile& file) {
    write_start(file, width, height, 16);
    write_rows(file, {width, height}, 6, fill_row);
}

} // namespace relief
