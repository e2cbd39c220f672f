// JPEG pictures read by libjpeg.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Opens a JPEG stream; returns nothing if the stream is none. Colours and CMYK become R, G, B, grey becomes
/// a channel Y. The orientation of Exif is followed. Throws Error{bad_input} for a damaged file, and for
/// components of an unknown kind.
std::unique_ptr<PixelSource> open_jpeg(std::unique_ptr<std::istream> stream, const std::string& name,
                                       PictureRemarks& remarks);

} // namespace relief
