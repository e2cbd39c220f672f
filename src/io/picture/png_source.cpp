#include "io/picture/png_source.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "io/count_things.h"
#include "io/picture/exif_orientation.h"
#include "io/picture/picture_error.h"
#include "io/picture/picture_text.h"
#include "io/picture/row_source.h"

namespace relief {

namespace {

/// Chunks whose faults change pixels. libpng reads on without them.
constexpr std::array<std::string_view, 3> kPixelChunks = {"PLTE", "tRNS", "IDAT"};

class PngSource final : public RowSource {
  public:
    PngSource(std::unique_ptr<std::istream> stream, std::string name, PictureRemarks& remarks)
        : name_(std::move(name)), stream_(std::move(stream)) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        try {
            run([&] { start(); });
            fill_header(remarks);
        } catch (...) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw;
        }
    }
    ~PngSource() override { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngSource(const PngSource&) = delete;
    PngSource& operator=(const PngSource&) = delete;

    std::vector<std::string> list_warnings() const override {
        std::vector<std::string> warnings;
        const auto add = [&](const std::string& fault) {
            warnings.push_back(fmt::format(
                "{}: is damaged, and parts of the picture may be wrong: {}: export or copy it again", name_,
                fault));
        };
        if (warning_[0]) add(fmt::format("libpng reports '{}'", make_printable(warning_.data())));
        if (lost_colors_ > 0)
            add(fmt::format("{} of a color that the palette lacks", count_things(lost_colors_, "pixel")));
        return warnings;
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

    void start() {
        constexpr uint32_t kMostSide = 1u << 30; // who opens the picture has limits of its own
        constexpr uint32_t kNoTexts = 1;         // libpng keeps one chunk less than this
        png_set_user_limits(png_, kMostSide, kMostSide);
        png_set_chunk_cache_max(png_, kNoTexts); // each text may unpack to 8 MB
        png_set_read_fn(png_, stream_.get(), on_read);
        png_read_info(png_, info_);
        is_palette_ = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
        stored_bits_ = png_get_bit_depth(png_, info_) * png_get_channels(png_, info_);
        if (is_palette_)
            png_set_packing(png_); // libpng makes black of colours that the palette lacks, without a word
        else
            png_set_expand(png_);
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
    }

    void fill_header(PictureRemarks& remarks) {
        header_.width = header_.full_width = int(png_get_image_width(png_, info_));
        header_.height = header_.full_height = int(png_get_image_height(png_, info_));
        is_wide_ = png_get_bit_depth(png_, info_) == 16;
        header_.type = is_wide_ ? SampleType::uint16 : SampleType::uint8;
        constexpr int kByteBits = 8;
        header_.pixel_bytes = uint64_t(std::max(1, stored_bits_ / kByteBits));
        if (is_palette_) read_palette();
        const int channels = is_palette_ ? (alpha_count_ > 0 ? 4 : 3) : int(png_get_channels(png_, info_));
        header_.channels =
            channels < 3 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
        header_.channels.resize(size_t(channels));
        png_byte* exif = nullptr;
        png_uint_32 exif_bytes = 0;
        if (png_get_eXIf_1(png_, info_, &exif_bytes, &exif) != 0)
            turn(find_tiff_orientation({exif, exif_bytes}), name_, remarks);
    }

    void read_palette() {
        palette_.fill({0, 0, 0, 255});
        png_color* colors = nullptr;
        if (png_get_PLTE(png_, info_, &colors, &color_count_) == 0)
            fail_damaged(name_, "has no palette, and its pixels are numbers of one");
        for (size_t k = 0; k < size_t(color_count_); ++k)
            palette_[k] = {colors[k].red, colors[k].green, colors[k].blue, 255};
        png_byte* alphas = nullptr;
        if (png_get_tRNS(png_, info_, &alphas, &alpha_count_, nullptr) == 0) return;
        for (size_t k = 0; k < size_t(std::min(alpha_count_, color_count_)); ++k) palette_[k][3] = alphas[k];
    }

    void decode(const VisitRow& visit) override {
        const size_t row_bytes = png_get_rowbytes(png_, info_), height = png_get_image_height(png_, info_);
        // An interlaced picture comes in passes over all rows.
        std::vector<uint8_t> bytes(row_bytes * (passes_ > 1 ? height : 1));
        std::vector<float> values(png_get_image_width(png_, info_) * header_.channels.size());
        for (int pass = 0; pass < passes_; ++pass) {
            for (size_t y = 0; y < height; ++y) {
                uint8_t* const row = bytes.data() + (passes_ > 1 ? y * row_bytes : 0);
                run([&] { png_read_row(png_, row, nullptr); });
                if (pass + 1 < passes_) continue;
                if (is_palette_)
                    look_up_colors(row, values);
                else
                    convert_row(row, values);
                visit(int(y), values.data());
            }
        }
        run([&] { png_read_end(png_, nullptr); });
    }

    void convert_row(const uint8_t* row, std::vector<float>& values) const {
        for (size_t k = 0; k < values.size(); ++k)
            values[k] = is_wide_ ? float(row[2 * k] << 8 | row[2 * k + 1]) * (1.0f / 65535)
                                 : float(row[k]) * (1.0f / 255);
    }

    void look_up_colors(const uint8_t* row, std::vector<float>& values) {
        const size_t channels = header_.channels.size();
        for (size_t x = 0; x < values.size() / channels; ++x) {
            lost_colors_ += row[x] >= color_count_ ? 1 : 0;
            for (size_t c = 0; c < channels; ++c)
                values[x * channels + c] = float(palette_[row[x]][c]) * (1.0f / 255);
        }
    }

    static void on_error(png_struct* png, const char* message) {
        auto& source = *static_cast<PngSource*>(png_get_error_ptr(png));
        std::snprintf(source.message_.data(), source.message_.size(), "%s", message);
        png_longjmp(png, 1);
    }
    /// Messages about a chunk begin with its name.
    static void on_warning(png_struct* png, const char* message) {
        auto& source = *static_cast<PngSource*>(png_get_error_ptr(png));
        const std::string_view text = message;
        if (source.warning_[0] || text.ends_with("xtra compressed data")) return;
        for (const std::string_view chunk : kPixelChunks)
            if (text.starts_with(chunk))
                std::snprintf(source.warning_.data(), source.warning_.size(), "%s", message);
    }
    static void on_read(png_struct* png, uint8_t* bytes, size_t count) {
        auto& stream = *static_cast<std::istream*>(png_get_io_ptr(png));
        stream.read(reinterpret_cast<char*>(bytes), std::streamsize(count));
        if (size_t(stream.gcount()) != count) png_error(png, "the file ends too early");
    }

    std::string name_;
    std::unique_ptr<std::istream> stream_;
    std::array<char, 128> message_{}, warning_{}; ///< of the error, and of the first fault in kPixelChunks
    png_struct* png_ = nullptr;
    png_info* info_ = nullptr;
    int passes_ = 1, stored_bits_ = 8; ///< bits per pixel
    bool is_wide_ = false, is_palette_ = false;
    std::array<std::array<uint8_t, 4>, 256> palette_; ///< opaque black beyond its colours
    int color_count_ = 0, alpha_count_ = 0;
    size_t lost_colors_ = 0;
};

} // namespace

std::unique_ptr<PixelSource> open_png(std::unique_ptr<std::istream> stream, const std::string& name,
                                      PictureRemarks& remarks) {
    constexpr size_t kSignatureBytes = 8;
    std::array<uint8_t, kSignatureBytes> start{};
    stream->read(reinterpret_cast<char*>(start.data()), std::streamsize(start.size()));
    const bool is_png = stream->gcount() == std::streamsize(kSignatureBytes) &&
                        png_sig_cmp(start.data(), 0, kSignatureBytes) == 0;
    if (!is_png) return nullptr;
    stream->seekg(0);
    return std::make_unique<PngSource>(std::move(stream), name, remarks);
}

} // namespace relief
