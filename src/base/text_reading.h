// Rules for all readers of text: byte order marks, ends of lines, depth of nesting.
#pragma once

#include <cstddef>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// The text behind the byte order mark of UTF-8, where it begins with one.
std::string_view skip_byte_order_mark(std::string_view text);

/// Whether the text begins with a byte order mark of UTF-16 or UTF-32, which no reader accepts.
bool is_wide_text(std::string_view text);
inline constexpr const char* kWideText = "is text in UTF-16 or UTF-32";
inline constexpr const char* kWideTextHint = "save it as UTF-8";

/// Takes a line off the front of a text. It ends with LF, CR, or CR and LF, or with the text.
std::string_view take_line(std::string_view& text);

/// Reads such a line from a stream, without a byte order mark at its start. Returns false at the end of the
/// stream.
bool read_line(std::istream& stream, std::string& line);

/// Line and column of a byte, from 1.
struct TextPlace {
    size_t line = 1, column = 1;
};
TextPlace find_place(std::string_view text, size_t byte);

/// Levels of arrays and objects in JSON. More are refused before a document is made: functions that walk
/// through it call themselves at each level.
inline constexpr size_t kMostNesting = 256;

/// The byte of the first bracket that opens a deeper level. Texts in quotes and comments do not count.
std::optional<size_t> find_deep_nesting(std::string_view json);

} // namespace relief
