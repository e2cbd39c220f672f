#include "io/mesh/ply_cursor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "base/text_reading.h"
#include "relief/error.h"

namespace relief {

void PlyCursor::fail(const std::string& message) const {
    const std::string place = format_ == PlyFormat::ascii
                                  ? fmt::format("line {}", find_place(bytes_, at_).line)
                                  : fmt::format("byte {}", at_);
    throw Error(ErrorKind::bad_input,
                {message, fmt::format("{}, {}, {} {}", name_, place, *element_, index_), kDamagedPlyHint});
}

uint64_t PlyCursor::read_whole(PlyType type, uint64_t end, const char* what) {
    const double value = read(type);
    if (!(value >= 0 && value < double(end)) || value != std::floor(value))
        fail(fmt::format("{} {} is out of range: there are {}", what, value, end));
    return uint64_t(value);
}

uint64_t PlyCursor::read_count(const PlyProperty& list) {
    const double value = read(*list.count_type);
    // A value of a text takes a digit and a space; behind the last one there may be none.
    const uint64_t left = bytes_.size() - at_;
    const uint64_t room = format_ == PlyFormat::ascii ? (left + 1) / 2 : left / get_byte_size(list.type);
    if (!(value >= 0 && value <= double(room)) || value != std::floor(value))
        fail(fmt::format("a list of {} values does not fit the file", value));
    return uint64_t(value);
}

void PlyCursor::skip(const PlyProperty& property) {
    const uint64_t count = property.count_type ? read_count(property) : 1;
    for (uint64_t k = 0; k < count; ++k) read(property.type);
}

namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_blank(char c) { return is_space(c) && c != '\n' && c != '\r'; }

} // namespace

void PlyCursor::begin_line() {
    while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
    line_end_ = find_line_end(at_);
}

void PlyCursor::leave_element() {
    while (at_ < line_end_ && is_blank(bytes_[at_])) ++at_;
    if (at_ >= line_end_ || bytes_[at_] == '\n' || bytes_[at_] == '\r') return;
    ends_in_lines_ = true;
    if (lines_ == PlyLines::ignored) return;
    if (long_line_count_++ == 0) first_long_line_ = at_;
    at_ = line_end_;
}

size_t PlyCursor::find_first_long_line() const { return find_place(bytes_, first_long_line_).line; }

uint64_t PlyCursor::count_lines() const {
    uint64_t count = 0;
    for (size_t at = at_; at < bytes_.size();) {
        const size_t end = find_line_end(at);
        if (!std::all_of(bytes_.begin() + ptrdiff_t(at), bytes_.begin() + ptrdiff_t(end), is_space)) ++count;
        at = end + 1;
    }
    return count;
}

double PlyCursor::read_word() {
    while (at_ < line_end_ && is_space(bytes_[at_])) ++at_;
    if (at_ < line_end_ && bytes_[at_] == '+') ++at_;
    double value = 0;
    const char *begin = bytes_.data() + at_, *end = bytes_.data() + line_end_;
    if (begin == end) fail(line_end_ == bytes_.size() ? "the file ends early" : "a line has too few numbers");
    const auto [stop, code] = std::from_chars(begin, end, value);
    if (code != std::errc() || (stop != end && !is_space(*stop)))
        fail("a number is missing, malformed or out of range");
    at_ += size_t(stop - begin);
    return value;
}

template <class T> double PlyCursor::take() {
    if (bytes_.size() - at_ < sizeof(T)) fail("the file ends early");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    const bool is_native =
        (format_ == PlyFormat::little_endian) == (std::endian::native == std::endian::little);
    if (!is_native) std::reverse(raw.begin(), raw.end());
    return double(std::bit_cast<T>(raw));
}

double PlyCursor::read_bytes(PlyType type) {
    using Cursor = PlyCursor;
    constexpr double (PlyCursor::*kTake[])() = {
        &Cursor::take<int8_t>,  &Cursor::take<uint8_t>,  &Cursor::take<int16_t>, &Cursor::take<uint16_t>,
        &Cursor::take<int32_t>, &Cursor::take<uint32_t>, &Cursor::take<float>,   &Cursor::take<double>};
    return (this->*kTake[size_t(type)])();
}

} // namespace relief
