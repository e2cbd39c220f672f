// Chunks of a PNG stream: those that describe colours, and lengths, which libpng trusts unread.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace relief {

/// True where a PNG chunk exceeds the stream of `stream_bytes`; false for other files. The position moves.
bool has_oversized_png_chunk(std::istream& stream, uint64_t stream_bytes);

/// The PNG chunk that says colours: "sRGB chunk", iCCP, cHRM, or gAMA but 1; or empty. The position moves.
std::string find_png_colour_tag(std::istream& stream);

} // namespace relief
