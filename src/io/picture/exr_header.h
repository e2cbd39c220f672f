// Attributes of an EXR header: those that describe colours, and sizes. OpenEXR trusts sizes, so that damaged
// ones take gigabytes, but reads most types without them: each size is checked against the file and its type.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

namespace relief {

/// Name of the first attribute of an EXR stream longer than the stream or not of its type's size; nothing
/// when all fit or it is no EXR. `stream_bytes`: its whole length; the position moves.
std::optional<std::string> find_missized_exr_attribute(std::istream& stream, uint64_t stream_bytes);

/// What the header of an EXR stream says of colours: "attribute chromaticities"; empty: nothing, or no EXR.
std::string find_exr_colour_tag(std::istream& stream);

} // namespace relief
