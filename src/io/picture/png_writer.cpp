// PNG by libpng.
#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include <png.h>

#include "base/parallel.h"
#include "io/picture/image_coders.h"

namespace relief {

namespace {

/// libpng's writer. Its errors are long jumps, which `run` turns into exceptions.
class PngStream {
  public:
    explicit PngStream(CheckedFile& file)
        : png_(png_create_write_struct_2(PNG_LIBPNG_VER_STRING, this, on_error, on_warning, this, allocate,
                                         release)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {
        if (!info_) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, &file, on_write, on_flush);
    }
    ~PngStream() { png_destroy_write_struct(&png_, &info_); }
    PngStream(const PngStream&) = delete;
    PngStream& operator=(const PngStream&) = delete;

    png_struct* png() { return png_; }
    png_info* info() { return info_; }

    /// `call` uses libpng and makes no object with a destructor: a jump would pass it by.
    template <class Call> void run(const Call& call) {
        if (setjmp(png_jmpbuf(png_)) == 0) {
            call();
            return;
        }
        if (is_out_of_memory_) throw std::bad_alloc();
        throw std::runtime_error(message_.data());
    }

  private:
    static void on_error(png_struct* png, const char* message) {
        auto& stream = *static_cast<PngStream*>(png_get_error_ptr(png));
        std::snprintf(stream.message_.data(), stream.message_.size(), "%s", message);
        png_longjmp(png, 1);
    }
    static void on_warning(png_struct*, const char*) {}
    static void on_write(png_struct* png, uint8_t* bytes, size_t count) {
        static_cast<CheckedFile*>(png_get_io_ptr(png))->write(bytes, count);
    }
    static void on_flush(png_struct*) {}
    static void* allocate(png_struct* png, png_alloc_size_t size) {
        void* memory = std::malloc(size);
        if (!memory) static_cast<PngStream*>(png_get_mem_ptr(png))->is_out_of_memory_ = true;
        return memory;
    }
    static void release(png_struct*, void* memory) { std::free(memory); }

    bool is_out_of_memory_ = false; // set while the next members are made
    std::array<char, 128> message_{};
    png_struct* png_;
    png_info* info_;
};

void set_header(PngStream& stream, int width, int height, const PngKind& kind) {
    constexpr size_t kChunkBytes = 1u << 16;
    png_struct* png = stream.png();
    // By default no more than a million each.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, stream.info(), uint32_t(width), uint32_t(height), kind.bits,
                 kind.channels == 4   ? PNG_COLOR_TYPE_RGB_ALPHA
                 : kind.channels == 1 ? PNG_COLOR_TYPE_GRAY
                                      : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_buffer_size(png, kChunkBytes);
}

/// Codes pictures up to five times as fast as the defaults of libpng do; renders became 1 % to 12 % larger.
/// The defaults try five filters per row and search long for repetitions, which noise does not have.
void set_quick_coding(PngStream& stream) {
    constexpr int kLevel = 3; // the last one of zlib that takes the first repetition that it finds
    png_set_filter(stream.png(), PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(stream.png(), kLevel);
}

void set_meaning(PngStream& stream, PngMeaning meaning) {
    if (meaning == PngMeaning::data) return;
    constexpr png_fixed_point kLinear = 100000, kSrgb = 45455; // 1 / 2.2, for programs that do not know sRGB
    if (meaning == PngMeaning::srgb) png_set_sRGB(stream.png(), stream.info(), PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_gAMA_fixed(stream.png(), stream.info(), meaning == PngMeaning::srgb ? kSrgb : kLinear);
}

/// Rows are filled block by block on several threads and coded by one.
void write_rows(PngStream& stream, int height, const FillRow<uint8_t>& fill_row) {
    constexpr size_t kBlockBytes = 1u << 20;
    stream.run([&] { png_write_info(stream.png(), stream.info()); });
    const size_t row_bytes = png_get_rowbytes(stream.png(), stream.info());
    const size_t block_height = std::clamp(kBlockBytes / row_bytes, size_t(1), size_t(height));
    std::vector<std::vector<uint8_t>> rows(block_height, std::vector<uint8_t>(row_bytes));
    for (size_t first = 0; first < size_t(height); first += block_height) {
        const size_t count = std::min(block_height, size_t(height) - first);
        parallel_for("fill PNG rows", count, 1, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) fill_row(int(first + k), rows[k]);
        });
        for (size_t k = 0; k < count; ++k) stream.run([&] { png_write_row(stream.png(), rows[k].data()); });
    }
    stream.run([&] { png_write_end(stream.png(), nullptr); });
}

} // namespace

void encode_png(int width, int height, const PngKind& kind, const FillRow<uint8_t>& fill_row,
                CheckedFile& file) {
    PngStream stream(file);
    stream.run([&] {
        set_header(stream, width, height, kind);
        set_meaning(stream, kind.meaning);
        if (kind.meaning != PngMeaning::data) set_quick_coding(stream);
    });
    write_rows(stream, height, fill_row);
}

} // namespace relief
