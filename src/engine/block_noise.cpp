#include "engine/block_noise.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "engine/picture_windows.h"

namespace relief {

namespace {

/// Standard errors that ImageSettings::noise is compared with: 95 of 100 values of a normal distribution lie
/// within 1.96, so that 95 of 100 pixels of a block are closer than 1.25 times the noise to their mean.
constexpr double kDeviations = 1.96 / 1.25;

} // namespace

double estimate_block_noise(const Film& film, const Window& block) {
    return kDeviations * film.estimate_error(block);
}

NoiseReport measure_noise(const Film& film, double noise) {
    const std::vector<Window> blocks = cut_into_windows(film.window(), kNoiseBlockEdge);
    std::vector<std::pair<double, uint64_t>> noises(blocks.size()); // and pixels
    parallel_for("measure_noise", blocks.size(), 64, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            noises[k] = {estimate_block_noise(film, blocks[k]), count_pixels(blocks[k])};
    });
    std::ranges::sort(noises);
    NoiseReport report{noise};
    for (const auto& [of_block, pixels] : noises) {
        report.pixels += pixels;
        if (of_block <= noise) report.reached_pixels += pixels;
    }
    if (report.reached_pixels == report.pixels) return report;
    report.most = noises.back().first;
    const uint64_t middle = report.reached_pixels + (report.pixels - report.reached_pixels + 1) / 2;
    uint64_t below = 0;
    for (auto block = noises.begin(); below < middle; ++block)
        report.median = block->first, below += block->second;
    return report;
}

} // namespace relief
