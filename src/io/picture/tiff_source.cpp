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
#include "relief/half.h"

namespace relief {

namespace {

/// What libtiff says, of one file.
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

template <class Value> Value get_tag(TIFF* tiff, uint32_t tag, Value value) {
    Value found{};
    return TIFFGetFieldDefaulted(tiff, tag, &found) == 1 ? found : value;
}

/// How the samples are stored.
struct Samples {
    uint16_t bits = 1, format = SAMPLEFORMAT_UINT, per_pixel = 1, photometric = 0,
             planar = PLANARCONFIG_CONTIG;

    explicit Samples(TIFF* tiff)
        : bits(get_tag<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1)),
          format(get_tag<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT)),
          per_pixel(get_tag<uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1)),
          planar(get_tag<uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG)) {
        photometric = uint16_t(per_pixel >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
        TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
        if (format == SAMPLEFORMAT_VOID) format = SAMPLEFORMAT_UINT;
        const auto compression = get_tag<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
        if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG && bits == 8) {
            TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
            photometric = PHOTOMETRIC_RGB;
        }
    }

    bool is_palette() const { return photometric == PHOTOMETRIC_PALETTE; }
    bool is_inverted() const { return photometric == PHOTOMETRIC_MINISWHITE; }
    bool is_float() const { return format == SAMPLEFORMAT_IEEEFP; }

    bool is_known() const {
        const bool has_color = photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_MINISBLACK ||
                               (is_inverted() && !is_float()) || (is_palette() && per_pixel == 1);
        const bool has_float = is_float() && (bits == 16 || bits == 32);
        const bool has_integer = format == SAMPLEFORMAT_UINT && (bits == 1 || bits == 2 || bits == 4 ||
                                                                 bits == 8 || bits == 16 || bits == 32);
        const bool is_small = bits < 8 && per_pixel > 1;
        return has_color && (has_float || (has_integer && (!is_palette() || bits <= 8))) && !is_small &&
               per_pixel > 0;
    }

    SampleType get_type() const {
        if (is_float()) return bits == 16 ? SampleType::float16 : SampleType::float32;
        return bits <= 8 ? SampleType::uint8 : bits == 16 ? SampleType::uint16 : SampleType::uint32;
    }
};

/// Sample `k` of a row, integers in [0, 1].
float load_sample(const uint8_t* row, size_t k, const Samples& samples) {
    const auto load = [&](auto value) {
        std::memcpy(&value, row + k * sizeof(value), sizeof(value));
        return value;
    };
    if (samples.is_float()) return samples.bits == 16 ? half_to_float(load(uint16_t())) : load(float());
    switch (samples.bits) {
    case 8:
        return float(row[k]) * (1.0f / 255);
    case 16:
        return float(load(uint16_t())) * (1.0f / 65535);
    case 32:
        return float(double(load(uint32_t())) / 4294967295.0);
    default:
        const size_t per_byte = 8u / samples.bits;
        const unsigned most = (1u << samples.bits) - 1,
                       shift = unsigned(samples.bits * (per_byte - 1 - k % per_byte));
        return float(row[k / per_byte] >> shift & most) / float(most);
    }
}

class TiffSource final : public RowSource {
  public:
    TiffSource(std::unique_ptr<std::istream> stream, std::string name, PictureRemarks& remarks)
        : name_(std::move(name)), stream_(std::move(stream)), tiff_(open()), samples_(tiff_.get()) {
        if (samples_.is_known()) read_header(remarks);
    }

    bool is_known() const { return samples_.is_known(); }

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

    void read_header(PictureRemarks& remarks) {
        TIFF* const tiff = tiff_.get();
        const auto width = get_tag<uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0),
                   height = get_tag<uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
        if (width > uint32_t(kMostSide) || height > uint32_t(kMostSide) || width == 0 || height == 0)
            fail_damaged(name_, fmt::format("has no pixels, or too many: {} x {}", width, height));
        header_.width = header_.full_width = int(width), header_.height = header_.full_height = int(height);
        header_.type = samples_.get_type();
        const size_t channels = samples_.is_palette() ? 3 : samples_.per_pixel;
        header_.pixel_bytes = std::max<uint64_t>(1, channels * samples_.bits / 8);
        static const std::vector<std::string> kColors = {"R", "G", "B", "A"}, kGreys = {"Y", "A"};
        const std::vector<std::string>& names = channels < 3 ? kGreys : kColors;
        for (size_t k = 0; k < channels; ++k)
            header_.channels.push_back(k < names.size() ? names[k] : fmt::format("channel{}", k));
        const int orientation = get_tag<uint16_t>(tiff, TIFFTAG_ORIENTATION, kUpright);
        if (orientation == kUpright) find_window(remarks);
        turn(orientation, name_, remarks);
    }

    /// Of a part of a larger picture, whose size is known.
    void find_window(PictureRemarks& remarks) {
        uint32_t full_width = 0, full_height = 0;
        float x = 0, y = 0, x_density = 1, y_density = 1;
        TIFF* const tiff = tiff_.get();
        if (TIFFGetField(tiff, TIFFTAG_PIXAR_IMAGEFULLWIDTH, &full_width) != 1 ||
            TIFFGetField(tiff, TIFFTAG_PIXAR_IMAGEFULLLENGTH, &full_height) != 1)
            return;
        TIFFGetField(tiff, TIFFTAG_XPOSITION, &x), TIFFGetField(tiff, TIFFTAG_YPOSITION, &y);
        const auto unit = get_tag<uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
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
        find_palette();
        if (TIFFIsTiled(tiff_.get()) != 0)
            decode_tiles(visit);
        else
            decode_lines(visit);
    }

    void find_palette() {
        if (!samples_.is_palette()) return;
        uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
        if (TIFFGetField(tiff_.get(), TIFFTAG_COLORMAP, &red, &green, &blue) != 1) fail();
        for (size_t k = 0; k < size_t(1) << samples_.bits; ++k)
            palette_.push_back(
                {float(red[k] >> 8) / 255, float(green[k] >> 8) / 255, float(blue[k] >> 8) / 255});
    }

    /// Samples of a row, or of one plane of it, into the values of all channels.
    void store(const uint8_t* row, size_t width, size_t plane, size_t first_x,
               std::vector<float>& values) const {
        const size_t channels = header_.channels.size();
        const bool is_contiguous = samples_.planar == PLANARCONFIG_CONTIG;
        const size_t count = is_contiguous && !samples_.is_palette() ? channels : 1;
        for (size_t x = 0; x < width; ++x) {
            float* const pixel = &values[(first_x + x) * channels];
            for (size_t c = 0; c < count; ++c) {
                const float value = load_sample(row, count * x + c, samples_);
                if (samples_.is_palette()) {
                    const auto index = size_t(value * float((1u << samples_.bits) - 1) + 0.5f);
                    std::copy(palette_[index].begin(), palette_[index].end(), pixel);
                } else {
                    pixel[is_contiguous ? c : plane] = samples_.is_inverted() && c == 0 ? 1 - value : value;
                }
            }
        }
    }

    size_t count_rows() const { return size_t(get_height()); }
    size_t count_planes() const { return samples_.planar == PLANARCONFIG_CONTIG ? 1 : samples_.per_pixel; }

    void decode_lines(const VisitRow& visit) {
        const auto width = size_t(get_width());
        std::vector<float> values(width * header_.channels.size());
        if (count_planes() > 1) return decode_planes(visit);
        std::vector<uint8_t> row(size_t(TIFFScanlineSize64(tiff_.get())) + 1);
        for (int y = 0; y < get_height(); ++y) {
            read_line(row.data(), y, 0);
            store(row.data(), width, 0, 0, values);
            visit(y, values.data());
        }
    }

    /// Planes lie one after another, and a compressed one is read from its beginning: all values first.
    void decode_planes(const VisitRow& visit) {
        const size_t width = size_t(get_width()), row_values = width * header_.channels.size();
        std::vector<uint8_t> row(size_t(TIFFScanlineSize64(tiff_.get())) + 1);
        std::vector<std::vector<float>> rows(count_rows(), std::vector<float>(row_values));
        for (size_t plane = 0; plane < count_planes(); ++plane)
            for (int y = 0; y < get_height(); ++y) {
                read_line(row.data(), y, plane);
                store(row.data(), width, plane, 0, rows[size_t(y)]);
            }
        for (int y = 0; y < get_height(); ++y) visit(y, rows[size_t(y)].data());
    }

    void read_line(uint8_t* row, int y, size_t plane) {
        messages_.last.clear();
        if (TIFFReadScanline(tiff_.get(), row, uint32_t(y), uint16_t(plane)) != 1 || !messages_.last.empty())
            fail();
    }

    void decode_tiles(const VisitRow& visit) {
        const auto tile_width = get_tag<uint32_t>(tiff_.get(), TIFFTAG_TILEWIDTH, 0),
                   tile_height = get_tag<uint32_t>(tiff_.get(), TIFFTAG_TILELENGTH, 0);
        const auto width = uint32_t(get_width()), height = uint32_t(get_height());
        constexpr uint64_t kMostTileBytes = uint64_t(1) << 30;
        if (tile_width == 0 || tile_height == 0 || TIFFTileSize64(tiff_.get()) > kMostTileBytes) fail();
        const auto row_bytes = size_t(TIFFTileRowSize64(tiff_.get()));
        std::vector<uint8_t> tile(size_t(TIFFTileSize64(tiff_.get())) + 1);
        std::vector<std::vector<float>> rows(std::min(tile_height, height),
                                             std::vector<float>(size_t(width) * header_.channels.size()));
        for (uint32_t top = 0; top < height; top += tile_height) {
            const uint32_t row_count = std::min(tile_height, height - top);
            for (uint32_t left = 0; left < width; left += tile_width)
                for (size_t plane = 0; plane < count_planes(); ++plane) {
                    messages_.last.clear();
                    if (TIFFReadTile(tiff_.get(), tile.data(), left, top, 0, uint16_t(plane)) < 0 ||
                        !messages_.last.empty())
                        fail();
                    for (uint32_t y = 0; y < row_count; ++y)
                        store(tile.data() + y * row_bytes, std::min(tile_width, width - left), plane, left,
                              rows[y]);
                }
            for (uint32_t y = 0; y < row_count; ++y) visit(int(top + y), rows[y].data());
        }
    }

    int get_width() const { return int(get_tag<uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0)); }
    int get_height() const { return int(get_tag<uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0)); }

    static constexpr int kMostSide = 1 << 20; ///< who opens the picture has a lower limit

    std::string name_;
    std::unique_ptr<std::istream> stream_;
    Messages messages_;
    Handle tiff_;
    Samples samples_;
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
    PictureRemarks own;
    auto source = std::make_unique<TiffSource>(std::move(stream), name, own);
    if (!source->is_known()) return nullptr;
    remarks.notes.insert(remarks.notes.end(), own.notes.begin(), own.notes.end());
    return source;
}

} // namespace relief
