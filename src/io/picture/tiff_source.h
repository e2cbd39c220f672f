// TIFF pictures read by libtiff.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// The first picture of a TIFF stream. Nothing where the stream is no TIFF file, or its samples are another
/// kind than grey, colours or a palette of 1 to 32 bits, whole numbers without a sign or floats. Palettes
/// become colours, grey is a channel Y. Its orientation is followed, and its place in a larger picture (the
/// tags of Pixar). Throws Error{bad_input} for a damaged file.
std::unique_ptr<PixelSource> open_tiff(std::unique_ptr<std::istream> stream, const std::string& name,
                                       PictureRemarks& remarks);

} // namespace relief
