// Plain EXR files read by OpenEXR itself.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/pixel_source.h"

namespace relief {

/// Nothing where the stream is no plain EXR: one part of flat pixels, all channels half or all float, at full
/// resolution, named R G B A, X Y Z, or alone in their layer. Throws Error{bad_input} for a damaged header.
std::unique_ptr<PixelSource> open_plain_exr(std::unique_ptr<std::istream> stream, const std::string& name);

} // namespace relief
