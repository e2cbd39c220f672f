#include "image/sample_range.h"

#include <charconv>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

std::string read_entry(const Image& image, const std::string& key) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::string() : found->second;
}

std::pair<int, int> read_sample_range(const Image& image, size_t part) {
    const std::string range = read_entry(image, kRenderedTag);
    const char* const end = range.data() + range.size();
    std::pair<int, int> result;
    const auto first = std::from_chars(range.data(), end, result.first);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == ':') {
        const auto last = std::from_chars(first.ptr + 1, end, result.second);
        if (last.ec == std::errc() && last.ptr == end && result.first >= 0 && result.second > result.first)
            return result;
    }
    throw Error(ErrorKind::bad_input,
                {fmt::format("no sample range \"A:B\" in the header entry {}", kRenderedTag),
                 fmt::format("part {}", part + 1), "merge joins EXR files written by relief render"});
}

std::optional<std::array<int, 4>> read_whole_window(const Image& image) {
    const std::string text = read_entry(image, "relief:whole_window");
    const char *at = text.data(), *const end = at + text.size();
    std::array<int, 4> window{};
    for (size_t k = 0; k < window.size(); ++k) {
        const auto number = std::from_chars(at, end, window[k]);
        const bool is_last = k + 1 == window.size();
        if (number.ec != std::errc() ||
            (is_last ? number.ptr != end : number.ptr == end || *number.ptr != ','))
            return std::nullopt;
        at = number.ptr + (is_last ? 0 : 1);
    }
    const auto [x0, y0, x1, y1] = window;
    const bool is_inside =
        x0 >= 0 && y0 >= 0 && x0 < x1 && y0 < y1 && x1 <= image.full_width && y1 <= image.full_height;
    return is_inside ? std::optional(window) : std::nullopt;
}

int read_whole_samples(const Image& image) {
    const std::string text = read_entry(image, "relief:whole_samples");
    const char* const end = text.data() + text.size();
    int count = 0;
    const auto number = std::from_chars(text.data(), end, count);
    return number.ec == std::errc() && number.ptr == end && count > 0 ? count : 0;
}

} // namespace relief
