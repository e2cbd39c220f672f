// PNG files read by libpng.
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "io/picture/pixel_source.h"

namespace relief {

/// Nothing where the stream is no PNG file. Palettes become colours, transparent colours an alpha; grey is a
/// channel Y. Throws Error{bad_input} for a damaged header.
std::unique_ptr<PixelSource> open_png(std::unique_ptr<std::istream> stream, const std::string& name);

} // namespace relief
