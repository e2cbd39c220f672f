// Kinds of samples in TIFF files, and how their bytes become numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <tiffio.h>

#include "relief/scene.h"

namespace relief {

/// How the samples of a pixel become the channels of a picture. `xyz`: libtiff makes CIE XYZ of LogLuv.
/// `converted`: libtiff makes 8-bit colours of the samples (YCbCr, Lab). `unknown`: Relief refuses the file.
enum class TiffColors { plain, inverted, palette, inks, xyz, converted, unknown };

template <class Value> Value get_tiff_tag(TIFF* tiff, uint32_t tag, Value value) {
    Value found{};
    return TIFFGetFieldDefaulted(tiff, tag, &found) == 1 ? found : value;
}

struct TiffSamples {
    uint16_t bits = 1, format = SAMPLEFORMAT_UINT, per_pixel = 1, photometric = 0,
             planar = PLANARCONFIG_CONTIG;
    TiffColors colors = TiffColors::unknown;

    /// Makes libtiff turn JPEG samples into RGB, and LogLuv into floats.
    explicit TiffSamples(TIFF* tiff);

    bool is_float() const { return format == SAMPLEFORMAT_IEEEFP; }
    bool is_contiguous() const { return planar == PLANARCONFIG_CONTIG; }
    size_t count_channels() const;
    SampleType get_type() const;
    /// Names the kind for a message.
    std::string describe() const;

    /// Sample `k` of a row: unsigned integers in [0, 1], signed ones in [-1, 1], an index of a palette as it
    /// is. Bytes are in the order of this machine, samples that are no whole bytes begin at the highest bit.
    float load(const uint8_t* row, size_t k) const;
};

} // namespace relief
