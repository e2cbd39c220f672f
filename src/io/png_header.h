// What libpng believes of a file before it reads it: chunk lengths. A damaged one would make it take
// gigabytes.
#pragma once

#include <cstdint>
#include <istream>

namespace relief {

/// True where a chunk of a PNG stream claims to reach beyond the stream; false for other kinds of files.
/// `stream_bytes` is its whole length; the position moves.
bool has_oversized_png_chunk(std::istream& stream, uint64_t stream_bytes);

} // namespace relief
