// Compares a noisy picture with stored means: block by block, in units of their common standard error.
// After Jarosz et al.: an image test must know the noise of both sides, or it is either blind or never quiet.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "relief/image.h"

namespace relief {

/// Mean radiance (average of R, G and B) of a block of pixels and the variance of that mean.
struct BlockMean {
    double mean = 0, variance = 0;
};

/// Splits the picture into blocks x blocks parts, row by row. Needs the layer "variance". The channels' noise
/// is taken as fully correlated, which can only overstate it.
inline std::vector<BlockMean> compute_block_means(const Image& image, int blocks) {
    std::vector<BlockMean> result(size_t(blocks) * size_t(blocks));
    std::vector<double> counts(result.size());
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const size_t block =
                size_t(y * blocks / image.height) * size_t(blocks) + size_t(x * blocks / image.width);
            double deviation = 0;
            for (const char* name : {"R", "G", "B"}) {
                result[block].mean += image.at(x, y, image.find_channel(name).value()) / 3;
                deviation +=
                    std::sqrt(image.at(x, y, image.find_channel(std::string("variance.") + name).value())) /
                    3;
            }
            result[block].variance += deviation * deviation;
            counts[block] += 1;
        }
    for (size_t k = 0; k < result.size(); ++k) {
        result[k].mean /= counts[k];
        result[k].variance /= counts[k] * counts[k];
    }
    return result;
}

/// Largest |difference| in standard errors. `relative_floor` of the mean is added to the error: what rounding
/// may do.
inline double compute_largest_z(std::span<const BlockMean> found, std::span<const BlockMean> expected,
                                double relative_floor = 1e-4) {
    double largest = 0;
    for (size_t k = 0; k < expected.size(); ++k) {
        const double error =
            std::sqrt(found[k].variance + expected[k].variance) + relative_floor * expected[k].mean;
        largest = std::max(largest, std::fabs(found[k].mean - expected[k].mean) / error);
    }
    return largest;
}

/// The blocks as C++ initialisers, to store them after a wanted change.
inline std::string print_block_means(std::span<const BlockMean> blocks) {
    std::string text;
    for (const BlockMean& block : blocks)
        text += fmt::format("{{{:.6g}, {:.3g}}}, ", block.mean, block.variance);
    return text;
}

} // namespace relief
