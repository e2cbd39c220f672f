#include "io/scene/file_sequence.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/scene/keyed_values.h"
#include "io/scene/tile_names.h"
#include "relief/io.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

/// Of the first part of a path that has a number.
std::pair<fs::path, std::string> split_at_number(const fs::path& path) {
    fs::path folder;
    for (const fs::path& part : path) {
        if (fill_frame_number(part.string(), 0) != part.string()) return {folder, part.string()};
        folder /= part;
    }
    return {folder, {}};
}

/// The number that a name has by a pattern.
std::optional<int64_t> match_number(const std::string& name, const std::string& pattern) {
    const size_t digits = pattern.find("##");
    if (name.size() <= digits || name.compare(0, digits, pattern, 0, digits) != 0) return std::nullopt;
    int64_t number = 0;
    const auto [end, error] = std::from_chars(name.data() + digits, name.data() + name.size(), number);
    if (error != std::errc()) return std::nullopt;
    const std::string filled = fill_frame_number(pattern, double(number));
    const bool is_match = has_tile_token(filled) ? !choose_tiles(filled, {name}).empty() : filled == name;
    return is_match ? std::optional(number) : std::nullopt;
}

} // namespace

std::string name_blend(const SequenceFiles& files) {
    if (files.second.empty()) return files.first;
    return fmt::format("{}..{}@{}", files.first, files.second, files.weight);
}

std::vector<int64_t> FileSequences::list_numbers(const std::string& pattern) const {
    const fs::path path(split_picture_name(pattern).file);
    const auto [folder, name] =
        split_at_number(find_with_slashes(path.is_absolute() ? path : folder_ / path));
    std::vector<int64_t> numbers;
    std::error_code code;
    for (fs::directory_iterator it(folder.empty() ? "." : folder, code), end; !code && it != end;
         it.increment(code))
        if (const auto number = match_number(it->path().filename().string(), name))
            numbers.push_back(*number);
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

int64_t FileSequences::hold(const std::string& pattern, int64_t number) {
    Numbers& numbers = numbers_[pattern];
    if (!std::ranges::binary_search(numbers.sorted, number) && !numbers.is_fresh)
        numbers = {list_numbers(pattern), true};
    if (numbers.sorted.empty()) return number;
    return std::clamp(number, numbers.sorted.front(), numbers.sorted.back());
}

SequenceFiles FileSequences::find_whole(const std::string& pattern, double frame) {
    SequenceFiles files;
    files.first_number = hold(pattern, int64_t(std::floor(frame)));
    files.first = fill_frame_number(pattern, double(files.first_number));
    return files;
}

SequenceFiles FileSequences::find_beside(const std::string& pattern, double frame) {
    SequenceFiles files = find_whole(pattern, frame);
    const double whole = std::floor(frame);
    files.second_number = hold(pattern, int64_t(whole) + 1);
    if (frame == whole || files.second_number == files.first_number || numbers_[pattern].sorted.empty())
        return files;
    files.second = fill_frame_number(pattern, double(files.second_number));
    files.weight = frame - whole;
    return files;
}

void FileSequences::refresh() {
    for (auto& [pattern, numbers] : numbers_) numbers.is_fresh = false;
}

} // namespace relief
