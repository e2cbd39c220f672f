#include "io/picture/tiff_samples.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "relief/half.h"

namespace relief {

namespace {

bool has_known_numbers(const TiffSamples& samples) {
    const unsigned bits = samples.bits;
    switch (samples.format) {
    case SAMPLEFORMAT_UINT:
        return bits >= 1 && bits <= 32;
    case SAMPLEFORMAT_INT:
        return bits == 8 || bits == 16 || bits == 32;
    case SAMPLEFORMAT_IEEEFP:
        return bits == 16 || bits == 32 || bits == 64;
    default:
        return false;
    }
}

TiffColors find_colors(TIFF* tiff, const TiffSamples& samples) {
    constexpr unsigned kMostPaletteBits = 16, kMostExtraSamples = 4;
    const bool is_whole = samples.format == SAMPLEFORMAT_UINT && samples.bits >= 1 && samples.bits <= 32;
    std::array<char, 1024> message{};
    switch (samples.photometric) {
    case PHOTOMETRIC_RGB:
    case PHOTOMETRIC_MINISBLACK:
        return has_known_numbers(samples) && samples.per_pixel > 0 ? TiffColors::plain : TiffColors::unknown;
    case PHOTOMETRIC_MINISWHITE:
        return is_whole && samples.per_pixel > 0 ? TiffColors::inverted : TiffColors::unknown;
    case PHOTOMETRIC_PALETTE:
        return is_whole && samples.bits <= kMostPaletteBits && samples.per_pixel >= 1 &&
                       samples.per_pixel <= 1 + kMostExtraSamples
                   ? TiffColors::palette
                   : TiffColors::unknown;
    case PHOTOMETRIC_SEPARATED:
        return is_whole && samples.per_pixel >= 4 && samples.per_pixel <= 4 + kMostExtraSamples &&
                       get_tiff_tag<uint16_t>(tiff, TIFFTAG_INKSET, INKSET_CMYK) == INKSET_CMYK
                   ? TiffColors::inks
                   : TiffColors::unknown;
    case PHOTOMETRIC_LOGL:
        return samples.bits == 32 && samples.is_float() && samples.per_pixel == 1 ? TiffColors::plain
                                                                                  : TiffColors::unknown;
    case PHOTOMETRIC_LOGLUV:
        return samples.bits == 32 && samples.is_float() && samples.per_pixel == 3 ? TiffColors::xyz
                                                                                  : TiffColors::unknown;
    case PHOTOMETRIC_YCBCR:
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
    case PHOTOMETRIC_ITULAB:
        return TIFFRGBAImageOK(tiff, message.data()) == 1 ? TiffColors::converted : TiffColors::unknown;
    default:
        return TiffColors::unknown;
    }
}

std::string name_photometric(unsigned photometric) {
    switch (photometric) {
    case PHOTOMETRIC_RGB:
        return "RGB";
    case PHOTOMETRIC_MINISBLACK:
        return "grey";
    case PHOTOMETRIC_MINISWHITE:
        return "inverted grey";
    case PHOTOMETRIC_PALETTE:
        return "palette";
    case PHOTOMETRIC_SEPARATED:
        return "ink";
    case PHOTOMETRIC_YCBCR:
        return "YCbCr";
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
    case PHOTOMETRIC_ITULAB:
        return "Lab";
    default:
        return fmt::format("photometric {}", photometric);
    }
}

template <class Value> Value load_value(const uint8_t* row, size_t k) {
    Value value;
    std::memcpy(&value, row + k * sizeof(value), sizeof(value));
    return value;
}

uint32_t load_bits(const uint8_t* row, size_t first, size_t count) {
    uint32_t value = 0;
    for (size_t bit = first; bit < first + count; ++bit)
        value = value << 1 | (row[bit / 8] >> (7 - bit % 8) & 1u);
    return value;
}

uint32_t load_unsigned(const uint8_t* row, size_t k, unsigned bits) {
    switch (bits) {
    case 8:
        return row[k];
    case 16:
        return load_value<uint16_t>(row, k);
    case 24:
        return uint32_t(row[3 * k]) | uint32_t(row[3 * k + 1]) << 8 | uint32_t(row[3 * k + 2]) << 16;
    case 32:
        return load_value<uint32_t>(row, k);
    default:
        return load_bits(row, k * bits, bits);
    }
}

float load_float(const uint8_t* row, size_t k, unsigned bits) {
    if (bits == 16) return half_to_float(load_value<uint16_t>(row, k));
    return bits == 32 ? load_value<float>(row, k) : float(load_value<double>(row, k));
}

float load_signed(const uint8_t* row, size_t k, unsigned bits) {
    const double value = bits == 8    ? double(int8_t(row[k])) / 127
                         : bits == 16 ? double(load_value<int16_t>(row, k)) / 32767
                                      : double(load_value<int32_t>(row, k)) / 2147483647.0;
    return float(std::max(value, -1.0));
}

} // namespace

TiffSamples::TiffSamples(TIFF* tiff)
    : bits(get_tiff_tag<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1)),
      format(get_tiff_tag<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT)),
      per_pixel(get_tiff_tag<uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1)),
      planar(get_tiff_tag<uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG)) {
    photometric = uint16_t(per_pixel >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    if (format == SAMPLEFORMAT_VOID) format = SAMPLEFORMAT_UINT;
    const auto compression = get_tiff_tag<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG && bits == 8 && per_pixel == 3 &&
        format == SAMPLEFORMAT_UINT) {
        TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        photometric = PHOTOMETRIC_RGB;
    }
    if (compression == COMPRESSION_SGILOG || compression == COMPRESSION_SGILOG24) {
        TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
        bits = get_tiff_tag<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
        format = get_tiff_tag<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    }
    colors = find_colors(tiff, *this);
}

size_t TiffSamples::count_channels() const {
    return colors == TiffColors::plain || colors == TiffColors::inverted ? per_pixel : 3;
}

SampleType TiffSamples::get_type() const {
    if (colors == TiffColors::palette || colors == TiffColors::converted) return SampleType::uint8;
    if (is_float()) return bits == 16 ? SampleType::float16 : SampleType::float32;
    return bits <= 8 ? SampleType::uint8 : bits <= 16 ? SampleType::uint16 : SampleType::uint32;
}

std::string TiffSamples::describe() const {
    const char* const number = is_float()                    ? "float"
                               : format == SAMPLEFORMAT_UINT ? "unsigned"
                               : format == SAMPLEFORMAT_INT  ? "signed"
                               : format == SAMPLEFORMAT_COMPLEXIEEEFP || format == SAMPLEFORMAT_COMPLEXINT
                                   ? "complex"
                                   : "unnamed";
    return fmt::format("{} per pixel, {}, {} bits, {}", per_pixel, name_photometric(photometric), bits,
                       number);
}

float TiffSamples::load(const uint8_t* row, size_t k) const {
    if (is_float()) return load_float(row, k, bits);
    if (format == SAMPLEFORMAT_INT) return load_signed(row, k, bits);
    const uint32_t value = load_unsigned(row, k, bits);
    if (colors == TiffColors::palette) return float(value);
    if (bits == 8) return float(value) * (1.0f / 255);
    if (bits == 16) return float(value) * (1.0f / 65535);
    if (bits < 8) return float(value) / float((1u << bits) - 1);
    return float(double(value) / double((uint64_t(1) << bits) - 1));
}

} // namespace relief
