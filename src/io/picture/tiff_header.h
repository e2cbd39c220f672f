// The one tag of a TIFF file that says something of colours.
#pragma once

#include <istream>
#include <string>

namespace relief {

/// "ICC profile" if the first picture of a classic TIFF has tag 34675, else empty. The position moves.
std::string find_tiff_colour_tag(std::istream& stream);

} // namespace relief
