// PNG files read by libpng.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Returns null if the stream is no PNG file. Palettes become colours, transparent colours become an alpha,
/// and grey is a channel Y. The picture is turned as its Exif data says. Throws Error{bad_input} for a
/// damaged header.
std::unique_ptr<PixelSource> open_png(std::unique_ptr<std::istream> stream, const std::string& name,
                                      PictureRemarks& remarks);

} // namespace relief
