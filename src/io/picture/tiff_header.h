// The one tag of a TIFF file that says something of colours.
#pragma once

#include <istream>
#include <string>

namespace relief {

/// "ICC profile" where the first picture of a TIFF stream (TIFF 6.0, classic, either byte order) has one (tag
/// 34675); empty: none, or another kind of file. The position moves.
std::string find_tiff_color_tag(std::istream& stream);

} // namespace relief
