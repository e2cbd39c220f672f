#include "common/values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "relief/render.h"

namespace relief::cli {

void refuse_value(const std::string& option, const std::string& text, const std::string& expected,
                  const std::string& hint) {
    throw Error(ErrorKind::usage, {fmt::format("'{}' is not {}", text, expected), option, hint});
}

std::string to_lower_case(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

namespace {

/// Where the digits begin: from_chars takes no plus sign.
const char* skip_plus(const std::string& text) {
    return text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
}

/// Nothing where a text is not a number from its beginning to its end.
std::optional<double> read_entire_number(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(skip_plus(text), end, value);
    if (result.ec != std::errc() || result.ptr != end || std::isnan(value)) return std::nullopt;
    return value;
}

/// What to write in place of a text that was not taken as a number in [low, high].
std::string hint_at_number(const std::string& text, double low, double high, bool is_whole) {
    const bool is_option =
        text.starts_with("--") || (text.size() == 2 && text[0] == '-' && std::isalpha(text[1]));
    if (is_option) return "the value is missing before it";
    if (const std::optional<double> value = read_entire_number(text)) {
        if (*value < low) return fmt::format("the least is {}", low);
        if (*value > high) return fmt::format("the most is {}", high);
        return "a whole number";
    }
    std::string pointed = text;
    std::ranges::replace(pointed, ',', '.');
    const std::optional<double> meant = read_entire_number(pointed);
    if (!is_whole && pointed != text && meant && *meant >= low && *meant <= high)
        return fmt::format("a point in place of the comma: {}", pointed);
    const char* const what = is_whole ? "digits alone" : "digits alone, with a point";
    const size_t unit = text.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ%");
    const std::optional<double> before = read_entire_number(text.substr(0, unit));
    const bool is_right =
        before && *before >= low && *before <= high && (!is_whole || *before == std::floor(*before));
    return is_right ? fmt::format("{}: {}", what, *before) : what;
}

} // namespace

int64_t parse_integer(const std::string& option, const std::string& text, int64_t low, int64_t high) {
    int64_t value = 0;
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(skip_plus(text), end, value);
    if (result.ec != std::errc() || result.ptr != end || value < low || value > high)
        refuse_value(option, text, fmt::format("an integer from {} to {}", low, high),
                     hint_at_number(text, double(low), double(high), true));
    return value;
}

double parse_number(const std::string& option, const std::string& text, double low, double high) {
    double value = 0;
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(skip_plus(text), end, value);
    if (result.ec != std::errc() || result.ptr != end || !(value >= low && value <= high))
        refuse_value(option, text, fmt::format("a number from {:g} to {:g}", low, high),
                     hint_at_number(text, low, high, false));
    return value;
}

std::vector<int64_t> parse_integers(const std::string& option, const std::string& text, char separator,
                                    size_t count, std::pair<int64_t, int64_t> range) {
    const std::vector<std::string> parts = split(text, separator);
    if (parts.size() != count)
        refuse_value(option, text, fmt::format("{} integers separated by '{}'", count, separator));
    std::vector<int64_t> values;
    for (const std::string& part : parts)
        values.push_back(parse_integer(option, part, range.first, range.second));
    return values;
}

namespace {

/// A size that may have been meant: of two numbers with another separator, or one number as a width at 16:9.
std::string suggest_size(const std::string& text, int64_t most) {
    std::string changed = text;
    for (char& c : changed)
        if (std::string_view("X*,:/ ").find(c) != std::string_view::npos) c = 'x';
    if (changed.find('x') == std::string::npos) changed += "x1";
    try {
        const std::vector<int64_t> size = parse_integers("", changed, 'x', 2, {1, most});
        if (changed.size() == text.size()) return changed;
        return fmt::format("{}x{}", size[0], std::max<int64_t>(1, size[0] * 9 / 16));
    } catch (const Error&) {
        return "1280x720";
    }
}

int parse_fixed_level(const std::string& option, const std::string& text, int most) {
    try {
        return int(parse_integer(option, text, 0, most));
    } catch (const Error&) {
        refuse_value(option, text, fmt::format("'auto' or an integer from 0 to {}", most),
                     "auto: fine enough for the size on screen");
    }
}

} // namespace

std::pair<int, int> parse_size(const std::string& option, const std::string& text, int64_t most) {
    try {
        const std::vector<int64_t> size = parse_integers(option, text, 'x', 2, {1, most});
        return {int(size[0]), int(size[1])};
    } catch (const Error&) {
        throw Error(ErrorKind::usage,
                    {fmt::format("'{}' is not WIDTHxHEIGHT, two integers from 1 to {}", text, most), option,
                     fmt::format("{} {}", option, suggest_size(text, most))});
    }
}

int parse_level(const std::string& text) {
    return text == "auto" ? kAutoLevel : parse_fixed_level("--level", text, kMaxLevel);
}

int parse_subdivision_level(const std::string& text) {
    return text == "auto" ? kAutoSubdivisionLevel
                          : parse_fixed_level("--subdivision-level", text, kMaxSubdivisionLevel);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    size_t begin = 0;
    while (true) {
        const size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
        if (end == std::string::npos) return parts;
        begin = end + 1;
    }
}

std::string get_lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

} // namespace relief::cli
