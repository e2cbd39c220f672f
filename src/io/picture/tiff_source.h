// TIFF pictures read by libtiff.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Opens the first picture of a TIFF stream; returns null for a stream that is no TIFF file. Grey, colours
/// and palettes are read with 1 to 32 bits (palettes: 16), grey and colours also as floats of 16, 32 or 64
/// bits and signed integers of 8, 16 or 32. Palettes and CMYK become colours, grey is a channel Y. LogLuv
/// becomes linear colours, and libtiff makes 8-bit colours of YCbCr and Lab. The picture is turned by its
/// orientation, and put into its place in a larger picture (the tags of Pixar). Throws Error{bad_input} for a
/// damaged file, and for other samples.
std::unique_ptr<PixelSource> open_tiff(std::unique_ptr<std::istream> stream, const std::string& name,
                                       PictureRemarks& remarks);

} // namespace relief
