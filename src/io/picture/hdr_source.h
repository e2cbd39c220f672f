// Radiance pictures: RGBE (Ward, "Real Pixels", Graphics Gems II, 1991).
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Nothing where the stream is no Radiance picture of red, green and blue. Rows and columns may run either
/// way. Throws Error{bad_input} for a damaged header.
std::unique_ptr<PixelSource> open_hdr(std::unique_ptr<std::istream> stream, const std::string& name,
                                      PictureRemarks& remarks);

} // namespace relief
