#include "io/picture/png_source.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <utility>
#include <vector>

#include <png.h>

#include "io/picture/picture_error.h"
#include "relief/half.h"

namespace relief {

namespace {

class PngSource final : public PixelSource {
  public:
    PngSource(std::unique_ptr<std::istream> stream, std::string name)
        : name_(std::move(name)), stream_(std::move(stream)) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        try {
            read_header();
        } catch (...) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw;
        }
    }
    ~PngSource() override { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngSource(const PngSource&) = delete;
    PngSource& operator=(const PngSource&) = delete;

    const PixelHeader& header() const override { return header_; }
    void read_floats(int channel_count, size_t stride, float* values) override {
        read(channel_count, stride, values, [](float value) { return value; });
    }
    void read_halves(int channel_count, size_t stride, uint16_t* values) override {
        read(channel_count, stride, values, [](float value) { return float_to_half(value); });
    }

  private:
    /// `call` uses libpng and makes no object with a destructor: a jump would pass it by.
    template <class Call> void run(const Call& call) {
        if (setjmp(png_jmpbuf(png_)) == 0) {
            call();
            return;
        }
        fail_damaged(name_, std::string("cannot be read: ") + message_.data());
    }

    void read_header() {
        run([&] {
            constexpr uint32_t kMostSide = 1u << 30; // who opens the picture has limits of its own
            png_set_user_limits(png_, kMostSide, kMostSide);
            png_set_read_fn(png_, stream_.get(), on_read);
            png_read_info(png_, info_);
            png_set_expand(png_);
            passes_ = png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        });
        header_.width = header_.full_width = int(png_get_image_width(png_, info_));
        header_.height = header_.full_height = int(png_get_image_height(png_, info_));
        const int channels = png_get_channels(png_, info_);
        is_wide_ = png_get_bit_depth(png_, info_) == 16;
        header_.type = is_wide_ ? SampleType::uint16 : SampleType::uint8;
        header_.pixel_bytes = uint64_t(channels) * (is_wide_ ? 2 : 1);
        header_.channels =
            channels < 3 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
        header_.channels.resize(size_t(channels));
    }

    template <class Value, class Convert>
    void read(int channel_count, size_t stride, Value* values, const Convert& convert) {
        const size_t row_bytes = png_get_rowbytes(png_, info_), height = size_t(header_.height);
        // An interlaced picture comes in passes over all rows.
        std::vector<uint8_t> bytes(row_bytes * (passes_ > 1 ? height : 1));
        for (int pass = 0; pass < passes_; ++pass) {
            for (size_t y = 0; y < height; ++y) {
                uint8_t* const row = bytes.data() + (passes_ > 1 ? y * row_bytes : 0);
                run([&] { png_read_row(png_, row, nullptr); });
                if (pass + 1 == passes_)
                    convert_row(row, channel_count, stride, values + y * size_t(header_.width) * stride,
                                convert);
            }
        }
        run([&] { png_read_end(png_, nullptr); });
    }

    template <class Value, class Convert>
    void convert_row(const uint8_t* row, int channel_count, size_t stride, Value* values,
                     const Convert& convert) const {
        const size_t channels = header_.channels.size();
        for (size_t x = 0; x < size_t(header_.width); ++x) {
            for (size_t c = 0; c < size_t(channel_count); ++c) {
                const size_t k = x * channels + c;
                const float value = is_wide_ ? float(row[2 * k] << 8 | row[2 * k + 1]) * (1.0f / 65535)
                                             : float(row[k]) * (1.0f / 255);
                values[x * stride + c] = convert(value);
            }
        }
    }

    static void on_error(png_struct* png, const char* message) {
        auto& source = *static_cast<PngSource*>(png_get_error_ptr(png));
        std::snprintf(source.message_.data(), source.message_.size(), "%s", message);
        png_longjmp(png, 1);
    }
    static void on_warning(png_struct*, const char*) {}
    static void on_read(png_struct* png, uint8_t* bytes, size_t count) {
        auto& stream = *static_cast<std::istream*>(png_get_io_ptr(png));
        stream.read(reinterpret_cast<char*>(bytes), std::streamsize(count));
        if (size_t(stream.gcount()) != count) png_error(png, "the file ends too early");
    }

    std::string name_;
    std::unique_ptr<std::istream> stream_;
    std::array<char, 128> message_{};
    png_struct* png_ = nullptr;
    png_info* info_ = nullptr;
    int passes_ = 1;
    bool is_wide_ = false;
    PixelHeader header_;
};

} // namespace

std::unique_ptr<PixelSource> open_png(std::unique_ptr<std::istream> stream, const std::string& name) {
    constexpr size_t kSignatureBytes = 8;
    std::array<uint8_t, kSignatureBytes> start{};
    stream->read(reinterpret_cast<char*>(start.data()), std::streamsize(start.size()));
    const bool is_png = stream->gcount() == std::streamsize(kSignatureBytes) &&
                        png_sig_cmp(start.data(), 0, kSignatureBytes) == 0;
    if (!is_png) return nullptr;
    stream->seekg(0);
    return std::make_unique<PngSource>(std::move(stream), name);
}

} // namespace relief
