// What the parts of a picture leave out of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "image/sample_range.h"
#include "relief/image.h"

namespace relief {

namespace {

struct Rectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0; ///< half open
    friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

using SampleRange = std::pair<int, int>;

struct CoveredPart {
    const Image* image;
    Rectangle window;
    SampleRange samples;
    std::optional<size_t> count_channel;
};

Rectangle get_window(const Image& image) {
    return {image.x0, image.y0, image.x0 + image.width, image.y0 + image.height};
}

/// The least number of samples that a pixel of the rectangle, inside the part, has.
int count_least_samples(const CoveredPart& part, const Rectangle& cell) {
    const int all = part.samples.second - part.samples.first;
    if (!part.count_channel) return all;
    float least = float(all);
    for (int y = cell.y0; y < cell.y1; ++y)
        for (int x = cell.x0; x < cell.x1; ++x)
            least = std::min(least, part.image->at(x, y, *part.count_channel));
    // Where noise was low enough the samples that are not there are not missing.
    const auto& metadata = part.image->metadata;
    const bool is_ended = metadata.contains("relief:interrupted") || metadata.contains("relief:time_limit");
    if (least > 0 && metadata.contains("relief:noise") && !is_ended) return all;
    return int(std::lround(least));
}

/// The rest of [0, `end`) beside ranges, in rising order.
std::vector<SampleRange> list_missing(std::vector<SampleRange> ranges, int end) {
    std::sort(ranges.begin(), ranges.end());
    std::vector<SampleRange> missing;
    int next = 0;
    for (const auto& [first, last] : ranges) {
        if (first > next) missing.emplace_back(next, first);
        next = std::max(next, last);
    }
    if (next < end) missing.emplace_back(next, end);
    return missing;
}

/// A part of the picture that no edge of a part crosses.
struct Cell {
    Rectangle window;
    std::vector<SampleRange> missing;
};

/// Cells of a band of rows, side by side; neighbours that lack the same are one.
std::vector<Cell> measure_band(const std::vector<CoveredPart>& parts, const Rectangle& band,
                               const std::set<int>& columns, int end) {
    std::vector<CoveredPart> touching;
    for (const CoveredPart& part : parts)
        if (part.window.y0 <= band.y0 && part.window.y1 >= band.y1) touching.push_back(part);
    std::vector<Cell> cells;
    for (auto right = std::next(columns.begin()); right != columns.end(); ++right) {
        const Rectangle window{*std::prev(right), band.y0, *right, band.y1};
        std::vector<SampleRange> ranges;
        for (const CoveredPart& part : touching) {
            if (part.window.x0 > window.x0 || part.window.x1 < window.x1) continue;
            const int count = count_least_samples(part, window);
            if (count > 0) ranges.emplace_back(part.samples.first, part.samples.first + count);
        }
        std::vector<SampleRange> missing = list_missing(std::move(ranges), end);
        if (!cells.empty() && cells.back().missing == missing)
            cells.back().window.x1 = window.x1;
        else
            cells.push_back({window, std::move(missing)});
    }
    return cells;
}

/// Appends the cells of a band, or makes those above longer where they lack the same.
void add_band(std::vector<Cell> band, std::vector<Cell>& cells) {
    const size_t above = cells.size();
    for (Cell& cell : band) {
        if (cell.missing.empty()) continue;
        const auto same =
            std::find_if(cells.begin(), cells.begin() + ptrdiff_t(above), [&](const Cell& upper) {
                return upper.window.y1 == cell.window.y0 && upper.window.x0 == cell.window.x0 &&
                       upper.window.x1 == cell.window.x1 && upper.missing == cell.missing;
            });
        if (same != cells.begin() + ptrdiff_t(above))
            same->window.y1 = cell.window.y1;
        else
            cells.push_back(std::move(cell));
    }
}

bool contains(const Rectangle& a, const Rectangle& b) {
    return a.x0 <= b.x0 && a.y0 <= b.y0 && a.x1 >= b.x1 && a.y1 >= b.y1;
}

/// The window that parts say they are of, and in which all others lie; or that all have; else the display
/// window.
Rectangle find_whole_window(std::span<const Image> images) {
    std::optional<Rectangle> named, common = get_window(images[0]);
    const Rectangle display{0, 0, images[0].full_width, images[0].full_height};
    for (const Image& image : images) {
        if (get_window(image) != common) common.reset();
        const std::optional<std::array<int, 4>> said = read_whole_window(image);
        if (!said) continue;
        const Rectangle whole{(*said)[0], (*said)[1], (*said)[2], (*said)[3]};
        if (named && whole != *named) return display;
        named = whole;
    }
    if (!named) return common.value_or(display);
    const auto is_inside = [&](const Image& image) { return contains(*named, get_window(image)); };
    return std::all_of(images.begin(), images.end(), is_inside) ? *named : display;
}

} // namespace

std::vector<PictureGap> find_gaps(std::span<const Image> images) {
    if (images.empty()) return {};
    std::vector<CoveredPart> parts;
    int end = 0;
    for (size_t k = 0; k < images.size(); ++k) {
        parts.push_back({&images[k], get_window(images[k]), read_sample_range(images[k], k),
                         images[k].find_channel("samples.Y")});
        end = std::max({end, parts.back().samples.second, read_whole_samples(images[k])});
    }
    const Rectangle whole = find_whole_window(images);
    std::set<int> columns{whole.x0, whole.x1}, rows{whole.y0, whole.y1};
    for (const CoveredPart& part : parts) {
        for (const int x : {part.window.x0, part.window.x1})
            if (x > whole.x0 && x < whole.x1) columns.insert(x);
        for (const int y : {part.window.y0, part.window.y1})
            if (y > whole.y0 && y < whole.y1) rows.insert(y);
    }
    std::vector<Cell> cells;
    for (auto bottom = std::next(rows.begin()); bottom != rows.end(); ++bottom)
        add_band(measure_band(parts, {whole.x0, *std::prev(bottom), whole.x1, *bottom}, columns, end), cells);
    std::vector<PictureGap> gaps;
    for (const Cell& cell : cells)
        for (const auto& [first, last] : cell.missing)
            gaps.push_back({cell.window.x0, cell.window.y0, cell.window.x1, cell.window.y1, first, last});
    return gaps;
}

} // namespace relief
