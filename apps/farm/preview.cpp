#include "farm/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "common/console.h"
#include "farm/attempts.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

int divide_up(int a, int b) { return (a + b - 1) / b; }

/// The mean of a square of the part, as far as it lies in it.
std::array<float, 3> average(const Image& part, int x0, int y0, int scale,
                             const std::array<size_t, 3>& channels) {
    const int x1 = std::min(x0 + scale, part.x0 + part.width),
              y1 = std::min(y0 + scale, part.y0 + part.height);
    std::array<double, 3> sums{};
    size_t count = 0;
    for (int y = std::max(y0, part.y0); y < y1; ++y)
        for (int x = std::max(x0, part.x0); x < x1; ++x, ++count)
            for (size_t c = 0; c < 3; ++c) sums[c] += double(part.at(x, y, channels[c]));
    std::array<float, 3> mean{};
    for (size_t c = 0; c < 3 && count > 0; ++c) mean[c] = float(sums[c] / double(count));
    return mean;
}

} // namespace

int get_preview_scale(const FarmJob& job) { return std::max(1, divide_up(job.width, kPreviewWidth)); }

Image make_preview(const Image& part, int scale) {
    Image preview;
    preview.full_width = divide_up(part.full_width, scale),
    preview.full_height = divide_up(part.full_height, scale);
    preview.x0 = divide_up(part.x0, scale), preview.y0 = divide_up(part.y0, scale);
    preview.width = divide_up(part.x0 + part.width, scale) - preview.x0;
    preview.height = divide_up(part.y0 + part.height, scale) - preview.y0;
    preview.channels = {"R", "G", "B"};
    const std::array<size_t, 3> channels = {part.find_channel("R").value(), part.find_channel("G").value(),
                                            part.find_channel("B").value()};
    for (int y = 0; y < preview.height; ++y)
        for (int x = 0; x < preview.width; ++x) {
            const std::array<float, 3> mean =
                average(part, (preview.x0 + x) * scale, (preview.y0 + y) * scale, scale, channels);
            preview.pixels.insert(preview.pixels.end(), mean.begin(), mean.end());
        }
    return preview;
}

void write_preview(const FarmJob& job, const FarmTask& task, const Image& part) {
    try {
        const Image preview = make_preview(part, get_preview_scale(job));
        if (preview.width > 0 && preview.height > 0) write_image(preview, get_preview_file(job, task.index));
    } catch (const std::exception& error) {
        print_error("relief: warning: no preview: {}\n", error.what());
    }
}

} // namespace relief::cli
