// Parses option values, with errors that name the option and its valid values.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace relief::cli {

[[noreturn]] void refuse_value(const std::string& option, const std::string& text,
                               const std::string& expected, const std::string& hint = {});

/// ASCII letters in lower case.
std::string to_lower_case(std::string text);

/// Integer in [low, high]; anything else, or trailing text, is a usage error that tells the range, and in its
/// hint the nearest end of it, or the number that the text begins with.
int64_t parse_integer(const std::string& option, const std::string& text, int64_t low, int64_t high);

/// Finite number in [low, high].
double parse_number(const std::string& option, const std::string& text, double low, double high);

/// "1280x720": width and height in [1, most]; the hint of the usage error shows what may have been meant.
std::pair<int, int> parse_size(const std::string& option, const std::string& text, int64_t most);

/// Exactly `count` integers in [low, high], separated by `separator`.
std::vector<int64_t> parse_integers(const std::string& option, const std::string& text, char separator,
                                    size_t count, std::pair<int64_t, int64_t> range);

/// A value of --level: auto, or cells 2^N a side.
int parse_level(const std::string& text);

/// A value of --subdivision-level: auto, or 2^N x 2^N patches a quad.
int parse_subdivision_level(const std::string& text);

/// Parts of "a,b,c"; an empty text has no parts.
std::vector<std::string> split(const std::string& text, char separator);

/// Extension in lower case with its dot: ".exr".
std::string get_lower_extension(const std::filesystem::path& file);

/// A word of a fixed list, with the nearest one as the hint; where none is near, with `help`.
template <class T, size_t N>
T parse_word(const std::string& option, const std::string& text,
             const std::array<std::pair<std::string_view, T>, N>& words,
             const char* help = "--help-all tells what they mean") {
    std::array<std::string_view, N> known;
    for (size_t i = 0; i < N; ++i) {
        if (words[i].first == text) return words[i].second;
        known[i] = words[i].first;
    }
    std::string hint = suggest_word(text, known);
    const bool is_option = option.starts_with("-");             // else a word of a file
    if (!hint.starts_with("did")) hint = is_option ? help : ""; // not the list, which the message has already
    throw Error(ErrorKind::usage,
                {fmt::format("'{}' is not one of: {}", text, fmt::join(known, ", ")), option, hint});
}

} // namespace relief::cli
