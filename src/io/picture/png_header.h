// Chunks of a PNG stream: those that describe colours, and lengths, which libpng trusts unread.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace relief {

/// True where a chunk of a PNG stream claims to reach beyond the stream; false for other kinds of files.
/// `stream_bytes` is its whole length; the position moves.
bool has_oversized_png_chunk(std::istream& stream, uint64_t stream_bytes);

/// Returns the chunk of a PNG stream that calls its values colours: "sRGB chunk", or iCCP, cHRM, or gAMA. For
/// a gamma of 1 alone it returns kLinearTag; without such a chunk, or for another stream, an empty text. The
/// position moves.
std::string find_png_color_tag(std::istream& stream);

} // namespace relief
