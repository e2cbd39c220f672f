// The header of a PLY file: which elements follow, and how each of their values is stored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type; ///< set for lists
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

/// Lines of a header that begin with words that PLY does not have.
struct PlyUnknownWords {
    size_t count = 0, first_line = 0;
    std::string first_word;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements; ///< each name once
    size_t byte_count = 0;            ///< of the header; the values begin there
    PlyUnknownWords unknown;          ///< passed over
};

/// `name` is for messages. Throws bad_input with the line for anything but a complete PLY header.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

/// Throws bad_input with the line where the header has unknown words.
void refuse_unknown_words(const PlyHeader& header, const std::string& name);

size_t get_byte_size(PlyType type);

} // namespace relief
