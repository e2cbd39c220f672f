// What OpenEXR believes of a header before it reads it: attribute sizes. A damaged one would make it take
// gigabytes.
#pragma once

#include <istream>
#include <optional>
#include <string>

namespace relief {

/// Name of the first attribute of an EXR stream that claims to be longer than the stream; nothing when all
/// fit, or when the stream is no EXR (the reader will say so). `stream_bytes` is its whole length; the
/// position moves.
std::optional<std::string> find_oversized_exr_attribute(std::istream& stream, uint64_t stream_bytes);

} // namespace relief
