// Values of a PLY file, one after another.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/mesh/ply_header.h"

namespace relief {

inline constexpr const char* kDamagedPlyHint = "the file is damaged or incomplete: export it again";

/// How text files are read. With `by_lines` every element is on a line of its own, and further numbers at its
/// end are left out.
enum class PlyLines { ignored, by_lines };

/// Knows its place for messages. Refers to the bytes and the name, which must outlive it.
class PlyCursor {
  public:
    PlyCursor(std::string_view bytes, const std::string& name, const PlyHeader& header,
              PlyLines lines = PlyLines::ignored)
        : bytes_(bytes),
          name_(name),
          format_(header.format),
          lines_(lines),
          at_(header.byte_count),
          line_end_(bytes.size()) {}

    /// What the next values belong to. The name must outlive the cursor.
    void enter(const std::string& element, uint64_t index) {
        if (format_ == PlyFormat::ascii && element_) leave_element();
        element_ = &element, index_ = index;
        if (lines_ == PlyLines::by_lines) begin_line();
    }

    /// Ends the reading: to be called after the last element.
    void finish() {
        if (format_ == PlyFormat::ascii && element_) leave_element();
    }

    /// Whether an element of a text file ended before its line did.
    bool ends_in_lines() const { return ends_in_lines_; }

    /// Lines that hold more numbers than their element has. By lines.
    size_t long_line_count() const { return long_line_count_; }
    size_t find_first_long_line() const;

    /// Lines that are not empty, from here to the end of the file. By lines.
    uint64_t count_lines() const;

    [[noreturn]] void fail(const std::string& message) const;

    /// Every type of PLY fits a double.
    double read(PlyType type) { return format_ == PlyFormat::ascii ? read_word() : read_bytes(type); }

    /// An integer below `end`.
    uint64_t read_whole(PlyType type, uint64_t end, const char* what);

    /// The number of values of a list, which must still be there.
    uint64_t read_count(const PlyProperty& list);

    /// Passes over a number or a list.
    void skip(const PlyProperty& property);

  private:
    void begin_line();
    void leave_element();
    size_t find_line_end(size_t at) const {
        return std::min(bytes_.find_first_of("\r\n", at), bytes_.size());
    }
    double read_word();
    double read_bytes(PlyType type);
    template <class T> double take();

    std::string_view bytes_;
    const std::string& name_;
    PlyFormat format_;
    PlyLines lines_;
    size_t at_;
    size_t line_end_; ///< where no value of this element goes beyond; by lines
    bool ends_in_lines_ = false;
    size_t long_line_count_ = 0, first_long_line_ = 0; ///< the latter as a byte
    const std::string* element_ = nullptr;
    uint64_t index_ = 0;
};

} // namespace relief
