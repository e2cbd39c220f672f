// Attributes of an EXR header: their sizes, which OpenEXR believes before it reads them (a damaged one would
// make it take gigabytes), and those that say something of colours.
// OpenEXR reads values of most types without a look at their size. Where the two differ it finds the next
// attribute elsewhere than who goes by sizes, so that a size is checked against its type as well.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

namespace relief {

/// Name of the first attribute of an EXR stream longer than the stream or not of its type's size; nothing
/// when all fit or it is no EXR. `stream_bytes`: its whole length; the position moves.
std::optional<std::string> find_missized_exr_attribute(std::istream& stream, uint64_t stream_bytes);

/// The compression of an EXR stream that OpenEXR of this build does not know, in any of its parts: its name,
/// or its number; empty: it knows all of them, or the stream is no EXR.
std::string find_unknown_exr_compression(std::istream& stream);

/// Whether the first part of an EXR stream says that its picture is the six faces of a cube.
bool is_exr_cube(std::istream& stream);

/// Tag of colours whose primaries or white are not those of Rec.709.
inline constexpr const char* kOtherPrimariesTag = "attribute chromaticities, which are not those of Rec.709";

/// Returns the entry of an EXR header that marks its values as colours: "attribute chromaticities",
/// kOtherPrimariesTag, or kRenderedTag for a picture that Relief rendered. Returns an empty text if the
/// header has no such entry, or if the stream is no EXR file.
std::string find_exr_color_tag(std::istream& stream);

} // namespace relief
