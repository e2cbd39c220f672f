// Numbers of frames in options, scene files and names of files.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <unordered_set>

#include <fmt/format.h>

#include "io/scene/keyed_values.h"
#include "relief/error.h"
#include "relief/shot.h"

namespace relief {

namespace {

constexpr int kDigits = 4; ///< of a frame's number, at least

[[noreturn]] void refuse_frames(std::string_view text, std::string message) {
    throw Error(ErrorKind::usage, {std::move(message), fmt::format("frames '{}'", text),
                                   "for example 1-100x2,150: from 1 to 100 every second one, and 150"});
}

/// Takes a number in [0, kMaxFrame] from the front.
std::optional<int> take_number(std::string_view& text) {
    int number = 0;
    if (text.starts_with('-')) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0 || number > kMaxFrame) return std::nullopt;
    text.remove_prefix(size_t(end - text.data()));
    return number;
}

bool take(std::string_view& text, char expected) {
    if (!text.starts_with(expected)) return false;
    text.remove_prefix(1);
    return true;
}

struct FrameRange {
    int first = 0, last = 0, step = 1;
};

std::optional<FrameRange> take_range(std::string_view& text) {
    const std::optional<int> first = take_number(text);
    if (!first) return std::nullopt;
    FrameRange range{*first, *first, 1};
    if (!take(text, '-')) return range;
    const std::optional<int> last = take_number(text);
    if (!last || *last < *first) return std::nullopt;
    range.last = *last;
    if (!take(text, 'x')) return range;
    const std::optional<int> step = take_number(text);
    if (!step || *step == 0) return std::nullopt;
    range.step = *step;
    return range;
}

} // namespace

std::vector<int> parse_frames(std::string_view text) {
    std::vector<int> frames;
    std::unordered_set<int> seen;
    std::string_view rest = text;
    do {
        const std::optional<FrameRange> range = take_range(rest);
        if (!range)
            refuse_frames(text, fmt::format("are no numbers from 0 to {}, or run backwards", kMaxFrame));
        for (int frame = range->first; frame <= range->last; frame += range->step)
            if (seen.insert(frame).second) frames.push_back(frame);
        if (frames.size() > kMaxFrames) refuse_frames(text, fmt::format("are more than {}", kMaxFrames));
    } while (take(rest, ','));
    if (!rest.empty()) refuse_frames(text, fmt::format("end with '{}'", rest));
    return frames;
}

std::filesystem::path name_frame(const std::filesystem::path& pattern, int frame) {
    const std::string name = pattern.filename().string();
    const std::string filled = fill_frame_number(name, frame);
    if (filled != name) return std::filesystem::path(pattern).replace_filename(filled);
    const std::string number = fmt::format(".{:0{}}", frame, kDigits), stem = pattern.stem().string();
    if (stem.ends_with(number)) return pattern;
    return std::filesystem::path(pattern).replace_filename(stem + number + pattern.extension().string());
}

} // namespace relief
