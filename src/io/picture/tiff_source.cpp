#include "io/picture/tiff_source.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include <tiffio.h>

#include <fmt/format.h>

#include "io/picture/picture_error.h"
#include "io/picture/row_source.h"
#include "io/picture/tiff_samples.h"
#include "relief/error.h"

namespace relief {

namespace {

/// The message that libtiff gave last for one file.
struct Messages {
    std::string last;
};

int on_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    std::array<char, 256> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    static_cast<Messages*>(user)->last = text.data();
    return 1;
}
int on_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

std::istream& get_stream(thandle_t handle) { return *static_cast<std::istream*>(handle); }

tmsize_t read_stream(thandle_t handle, void* bytes, tmsize_t count) {
    std::istream& stream = get_stream(handle);
    stream.read(static_cast<char*>(bytes), std::streamsize(count));
    const auto done = tmsize_t(stream.gcount());
    stream.clear();
    return done;
}
tmsize_t write_stream(thandle_t, void*, tmsize_t) { return 0; }
toff_t seek_stream(thandle_t handle, toff_t offset, int whence) {
    std::istream& stream = get_stream(handle);
    stream.clear();
    stream.seekg(std::streamoff(offset), whence == SEEK_SET   ? std::ios::beg
                                         : whence == SEEK_CUR ? std::ios::cur
                                                              : std::ios::end);
    if (!stream) return toff_t(-1);
    return toff_t(std::streamoff(stream.tellg()));
}
int close_stream(thandle_t) { return 0; }
toff_t measure_stream(thandle_t handle) {
    std::istream& stream = get_stream(handle);
    const std::streamoff at = stream.tellg();
    stream.seekg(0, std::ios::end);
    const std::streamoff end = stream.tellg();
    stream.seekg(at);
    return toff_t(end);
}

class TiffSource final : public RowSource {
  public:
    TiffSource(std::unique_ptr<std::istream> stream, std::string name, PictureRemarks& remarks)
        : name_(std::move(name)), stream_(std::move(stream)), tiff_(open()), samples_(tiff_.get()) {
        refuse_unknown();
        read_header(remarks);
    }

  private:
    struct Close {
        void operator()(TIFF* tiff) const { TIFFClose(tiff); }
    };
    using Handle = std::unique_ptr<TIFF, Close>;

    Handle open() {
        constexpr tmsize_t kMostMemory = tmsize_t(1) << 30; // of one strip or tile
        TIFFOpenOptions* const options = TIFFOpenOptionsAlloc();
        TIFFOpenOptionsSetMaxSingleMemAlloc(options, kMostMemory);
        TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, &messages_);
        TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, nullptr);
        // "m": not mapped into memory.
        Handle tiff(TIFFClientOpenExt(name_.c_str(), "rm", stream_.get(), read_stream, write_stream,
                                      seek_stream, close_stream, measure_stream, nullptr, nullptr, options));
        TIFFOpenOptionsFree(options);
        if (!tiff) fail_damaged(name_, "cannot be opened: " + messages_.last);
        return tiff;
    }

    [[noreturn]] void fail() const { fail_damaged(name_, "cannot be read: " + messages_.last); }

    void refuse_unknown() const {
        const auto compression = get_tiff_tag<uint16_t>(tiff_.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE);
        if (TIFFIsCODECConfigured(compression) != 1)
            throw Error(ErrorKind::bad_input,
                        {fmt::format("has a compression that Relief does not read ({})", compression), name_,
                         "save it uncompressed, or with LZW or ZIP compression"});
        if (samples_.colors == TiffColors::unknown)
            throw Error(ErrorKind::bad_input,
                        {fmt::format("has samples that Relief does not read ({})", samples_.describe()),
                         name_, "save it as RGB or grey with 8, 16 or 32 bits per sample"});
    }

    void read_header(PictureRemarks& remarks) {
        TIFF* const tiff = tiff_.get();
        const auto width = get_tiff_tag<uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0),
                   height = get_tiff_tag<uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
        if (width > uint32_t(kMostSide) || height > uint32_t(kMostSide) || width == 0 || height == 0)
            fail_damaged(name_, fmt::format("has no pixels, or too many: {} x {}", width, height));
        header_.width = header_.full_width = int(width), header_.height = header_.full_height = int(height);
        if (samples_.colors == TiffColors::inks) remarks.warnings.push_back(describe_inks(name_));
        header_.type = samples_.get_type();
        const size_t channels = samples_.count_channels();
        header_.pixel_bytes =
            std::max<uint64_t>(1, std::max<size_t>(channels, samples_.per_pixel) * samples_.bits / 8);
        static const std::vector<std::string> kColors = {"R", "G", "B", "A"}, kGreys = {"Y", "A"};
        const std::vector<std::string>& names = channels < 3 ? kGreys : kColors;
        for (size_t k = 0; k < channels; ++k)
            header_.channels.push_back(k < names.size() ? names[k] : fmt::format("channel{}", k));
        const int orientation = get_tiff_tag<uint16_t>(tiff, TIFFTAG_ORIENTATION, kUpright);
        if (orientation == kUpright) find_window(remarks);
        turn(orientation, name_, remarks);
    }

    /// Finds the place of the picture in a larger one, where the file has both sizes.
    void find_window(PictureRemarks& remarks) {
        uint32_t full_width = 0, full_height = 0;
        float x = 0, y = 0, x_density = 1, y_density = 1;
        TIFF* const tiff = tiff_.get();
        if (TIFFGetField(tiff, TIFFTAG_PIXAR_IMAGEFULLWIDTH, &full_width) != 1 ||
            TIFFGetField(tiff, TIFFTAG_PIXAR_IMAGEFULLLENGTH, &full_height) != 1)
            return;
        TIFFGetField(tiff, TIFFTAG_XPOSITION, &x), TIFFGetField(tiff, TIFFTAG_YPOSITION, &y);
        const auto unit = get_tiff_tag<uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
        if (unit != RESUNIT_NONE) {
            TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x_density),
                TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y_density);
            x *= x_density, y *= y_density;
        }
        const bool is_sound = x >= 0 && y >= 0 && x < float(kMostSide) && y < float(kMostSide) &&
                              full_width > 0 && full_height > 0 && full_width <= uint32_t(kMostSide) &&
                              full_height <= uint32_t(kMostSide);
        const bool is_whole = x == 0 && y == 0 && full_width == uint32_t(header_.width) &&
                              full_height == uint32_t(header_.height);
        if (!is_sound || is_whole) return;
        header_.x = int(x), header_.y = int(y);
        header_.full_width = int(full_width), header_.full_height = int(full_height);
        remarks.notes.push_back(
            fmt::format("{}: holds {} x {} pixels at ({}, {}) of a picture of {} x {}; the rest "
                        "is 0",
                        name_, header_.width, header_.height, header_.x, header_.y, full_width, full_height));
    }

    void decode(const VisitRow& visit) override {
        if (samples_.colors == TiffColors::palette) find_palette();
        if (samples_.colors == TiffColors::converted)
            decode_colors(visit);
        else if (TIFFIsTiled(tiff_.get()) != 0)
            decode_tiles(visit);
        else if (count_planes() > 1)
            decode_planes(visit);
        else
            decode_lines(visit);
    }

    void find_palette() {
        uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
        if (TIFFGetField(tiff_.get(), TIFFTAG_COLORMAP, &red, &green, &blue) != 1)
            fail_damaged(name_, "has no palette for its pixels");
        palette_.clear();
        for (size_t k = 0; k < size_t(1) << samples_.bits; ++k)
            palette_.push_back(
                {float(red[k] >> 8) / 255, float(green[k] >> 8) / 255, float(blue[k] >> 8) / 255});
    }

    /// Loads the samples of a row, or of one plane of it, into a row of all samples.
    void store(const uint8_t* row, size_t width, size_t plane, size_t first_x,
               std::vector<float>& samples) const {
        const size_t count = count_row_samples(), step = samples_.per_pixel;
        for (size_t x = 0; x < width; ++x)
            for (size_t c = 0; c < count; ++c)
                samples[(first_x + x) * step + plane + c] = samples_.load(row, count * x + c);
    }

    void find_color(const float* samples, float* color) const {
        if (samples_.colors == TiffColors::palette) {
            const auto& entry = palette_[std::min(size_t(samples[0]), palette_.size() - 1)];
            std::copy(entry.begin(), entry.end(), color);
        } else if (samples_.colors == TiffColors::xyz) { // as tif_luv.c of libtiff, for primaries of Rec.709
            const float x = samples[0], y = samples[1], z = samples[2];
            color[0] = 2.690f * x - 1.276f * y - 0.414f * z;
            color[1] = -1.022f * x + 1.978f * y + 0.044f * z;
            color[2] = 0.061f * x - 0.224f * y + 1.163f * z;
        } else { // cyan, magenta, yellow and black
            for (size_t c = 0; c < 3; ++c) color[c] = (1 - samples[c]) * (1 - samples[3]);
        }
    }

    /// Makes channels of all samples of a row.
    void visit_samples(const VisitRow& visit, int y, std::vector<float>& samples) const {
        const size_t step = samples_.per_pixel, width = size_t(get_width());
        if (samples_.colors == TiffColors::plain) return visit(y, samples.data());
        if (samples_.colors == TiffColors::inverted) {
            for (size_t x = 0; x < width; ++x) samples[x * step] = 1 - samples[x * step];
            return visit(y, samples.data());
        }
        std::vector<float> colors(width * 3);
        for (size_t x = 0; x < width; ++x) find_color(&samples[x * step], &colors[3 * x]);
        visit(y, colors.data());
    }

    /// Samples of a pixel that are stored beside each other.
    size_t count_row_samples() const { return samples_.is_contiguous() ? samples_.per_pixel : 1; }
    size_t count_planes() const { return samples_.is_contiguous() ? 1 : samples_.per_pixel; }

    /// Returns room for the bytes of rows of `width` pixels, as libtiff fills it, and checks its size.
    std::vector<uint8_t> make_row_bytes(uint64_t width, uint64_t row_bytes, uint64_t bytes) const {
        constexpr uint64_t kMostBytes = uint64_t(1) << 30;
        constexpr uint64_t kBestCompression = 8192, kSlack = uint64_t(4) << 20; // as of whole pictures
        const uint64_t file_bytes = measure_stream(stream_.get());
        if (bytes > std::min(kMostBytes, file_bytes * kBestCompression + kSlack) ||
            width * count_row_samples() * samples_.bits > row_bytes * 8)
            fail_damaged(name_,
                         fmt::format("has rows or tiles of {} bytes for {} pixels each", bytes, width));
        return std::vector<uint8_t>(size_t(bytes) + 1);
    }
    std::vector<uint8_t> make_line_bytes() const {
        const uint64_t bytes = TIFFScanlineSize64(tiff_.get());
        return make_row_bytes(uint64_t(get_width()), bytes, bytes);
    }

    void decode_lines(const VisitRow& visit) {
        const auto width = size_t(get_width());
        std::vector<float> samples(width * samples_.per_pixel);
        std::vector<uint8_t> row = make_line_bytes();
        for (int y = 0; y < get_height(); ++y) {
            read_line(row.data(), y, 0);
            store(row.data(), width, 0, 0, samples);
            visit_samples(visit, y, samples);
        }
    }

    /// Planes are stored one after another, and a compressed one is read from its beginning: this reads all
    /// samples first.
    void decode_planes(const VisitRow& visit) {
        const auto width = size_t(get_width());
        std::vector<uint8_t> row = make_line_bytes();
        std::vector<std::vector<float>> rows(size_t(get_height()),
                                             std::vector<float>(width * samples_.per_pixel));
        for (size_t plane = 0; plane < count_planes(); ++plane)
            for (int y = 0; y < get_height(); ++y) {
                read_line(row.data(), y, plane);
                store(row.data(), width, plane, 0, rows[size_t(y)]);
            }
        for (int y = 0; y < get_height(); ++y) visit_samples(visit, y, rows[size_t(y)]);
    }

    void read_line(uint8_t* row, int y, size_t plane) {
        messages_.last.clear();
        if (TIFFReadScanline(tiff_.get(), row, uint32_t(y), uint16_t(plane)) != 1 || !messages_.last.empty())
            fail();
    }

    void decode_tiles(const VisitRow& visit) {
        const auto tile_width = get_tiff_tag<uint32_t>(tiff_.get(), TIFFTAG_TILEWIDTH, 0),
                   tile_height = get_tiff_tag<uint32_t>(tiff_.get(), TIFFTAG_TILELENGTH, 0);
        const auto width = uint32_t(get_width()), height = uint32_t(get_height());
        const uint64_t row_bytes = TIFFTileRowSize64(tiff_.get());
        if (tile_width == 0 || tile_height == 0) fail_damaged(name_, "has tiles without a size");
        std::vector<uint8_t> tile = make_row_bytes(tile_width, row_bytes, TIFFTileSize64(tiff_.get()));
        if (row_bytes * tile_height > tile.size()) fail_damaged(name_, "has tiles of two sizes");
        std::vector<std::vector<float>> rows(std::min(tile_height, height),
                                             std::vector<float>(size_t(width) * samples_.per_pixel));
        for (uint32_t top = 0; top < height; top += std::min(tile_height, height)) {
            const uint32_t row_count = std::min(tile_height, height - top);
            for (uint32_t left = 0; left < width; left += std::min(tile_width, width))
                for (size_t plane = 0; plane < count_planes(); ++plane) {
                    messages_.last.clear();
                    if (TIFFReadTile(tiff_.get(), tile.data(), left, top, 0, uint16_t(plane)) < 0 ||
                        !messages_.last.empty())
                        fail();
                    for (uint32_t y = 0; y < row_count; ++y)
                        store(tile.data() + y * row_bytes, std::min(tile_width, width - left), plane, left,
                              rows[y]);
                }
            for (uint32_t y = 0; y < row_count; ++y) visit_samples(visit, int(top + y), rows[y]);
        }
    }

    /// Reads the colours that libtiff makes of other samples.
    void decode_colors(const VisitRow& visit) {
        const auto width = size_t(get_width()), height = size_t(get_height());
        std::vector<uint32_t> raster(width * height);
        std::array<char, 1024> message{};
        TIFFRGBAImage image;
        messages_.last.clear();
        if (TIFFRGBAImageBegin(&image, tiff_.get(), 1, message.data()) != 1)
            fail_damaged(name_, fmt::format("cannot be read: {}", message.data()));
        image.req_orientation = image.orientation; // RowSource turns the picture
        const int is_read = TIFFRGBAImageGet(&image, raster.data(), uint32_t(width), uint32_t(height));
        TIFFRGBAImageEnd(&image);
        if (is_read != 1 || !messages_.last.empty()) fail();
        std::vector<float> colors(width * 3);
        for (size_t y = 0; y < height; ++y) {
            for (size_t x = 0; x < width; ++x) {
                const uint32_t color = raster[y * width + x];
                colors[3 * x] = float(TIFFGetR(color)) / 255,
                           colors[3 * x + 1] = float(TIFFGetG(color)) / 255,
                           colors[3 * x + 2] = float(TIFFGetB(color)) / 255;
            }
            visit(int(y), colors.data());
        }
    }

    int get_width() const { return int(get_tiff_tag<uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0)); }
    int get_height() const { return int(get_tiff_tag<uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0)); }

    static constexpr int kMostSide = 1 << 20; ///< who opens the picture has a lower limit

    std::string name_;
    std::unique_ptr<std::istream> stream_;
    Messages messages_;
    Handle tiff_;
    TiffSamples samples_;
    std::vector<std::array<float, 3>> palette_;
};

} // namespace

std::unique_ptr<PixelSource> open_tiff(std::unique_ptr<std::istream> stream, const std::string& name,
                                       PictureRemarks& remarks) {
    std::array<char, 4> start{};
    stream->read(start.data(), 4);
    const auto is_start = [&](const char* text) { return std::memcmp(start.data(), text, 4) == 0; };
    if (!*stream ||
        !(is_start("II\x2a\0") || is_start("MM\0\x2a") || is_start("II\x2b\0") || is_start("MM\0\x2b")))
        return nullptr;
    stream->seekg(0);
    return std::make_unique<TiffSource>(std::move(stream), name, remarks);
}

} // namespace relief
