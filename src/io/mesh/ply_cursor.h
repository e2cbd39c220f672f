// Values of a PLY file, one after another.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/mesh/ply_header.h"

namespace relief {

inline constexpr const char* kDamagedPlyHint = "the file is damaged or incomplete: export it again";

/// Knows its place for messages. Refers to the bytes and the name, which must outlive it.
class PlyCursor {
  public:
    PlyCursor(std::string_view bytes, const std::string& name, const PlyHeader& header)
        : bytes_(bytes), name_(name), format_(header.format), at_(header.byte_count) {}

    /// What the next values belong to. The name must outlive the cursor.
    void enter(const std::string& element, uint64_t index) { element_ = &element, index_ = index; }

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
    double read_word();
    double read_bytes(PlyType type);
    template <class T> double take();

    std::string_view bytes_;
    const std::string& name_;
    PlyFormat format_;
    size_t at_;
    const std::string* element_ = nullptr;
    uint64_t index_ = 0;
};

} // namespace relief
