#include "io/mesh/obj_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

constexpr std::string_view kSpaces = " \t\v\f";

/// Takes the first word off `line`; empty at its end and before a comment.
std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kSpaces), line.size()));
    if (line.starts_with('#')) line = {};
    const std::string_view word = line.substr(0, line.find_first_of(kSpaces));
    line.remove_prefix(word.size());
    return word;
}

bool is_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    // What is out of range is known by its value when it has been read.
    return code != std::errc::invalid_argument && stop == word.data() + word.size() && std::isfinite(value);
}

/// Numbers that a statement must have at least; 0: it is none of them.
size_t count_needed(std::string_view keyword) {
    if (keyword == "v" || keyword == "vn") return 3;
    return keyword == "vt" ? 1 : 0;
}

[[noreturn]] void fail(std::string message, const std::string& name, size_t line) {
    throw Error(ErrorKind::bad_input, {std::move(message), fmt::format("{}, line {}", name, line),
                                       "numbers are written as 1.5 or 1e-3: export it again"});
}

} // namespace

void check_obj_numbers(std::string_view text, const std::string& name) {
    for (size_t number = 1; !text.empty(); ++number) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end);
        text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<size_t>(text.size(), 1));
        const std::string_view keyword = take_word(line);
        const size_t needed = count_needed(keyword);
        if (needed == 0) continue;
        size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count)
            if (!is_number(word)) fail(fmt::format("'{}' is no number", word.substr(0, 40)), name, number);
        if (count < needed)
            fail(fmt::format("'{}' has {} of {} numbers", keyword, count, needed), name, number);
    }
}

} // namespace relief
