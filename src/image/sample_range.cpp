#include "image/sample_range.h"

#include <charconv>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

std::pair<int, int> read_sample_range(const Image& image, size_t part) {
    const auto found = image.metadata.find(kRenderedTag);
    const std::string range = found == image.metadata.end() ? std::string() : found->second;
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

} // namespace relief
