// Whether the Vulkan engine sees what the CPU engine sees, on sample scenes made in memory.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "relief/image.h"
#include "relief/render.h"

namespace relief::gpu {

/// First hits of two pictures with the layers depth and id, of the same samples.
struct HitDifference {
    size_t pixels = 0;
    size_t one_only = 0;                 ///< hit in one picture only
    size_t other_depth = 0;              ///< hit in both, depth further apart than kLargestDepthDifference
    size_t other_id = 0;                 ///< hit in both at one depth, but different objects
    double largest_depth_difference = 0; ///< relative, of the pixels that agree
    double share() const { return double(one_only + other_depth + other_id) / double(pixels); }
};

inline constexpr double kLargestDepthDifference = 1e-4; ///< relative
inline constexpr double kLargestShare = 1e-4;           ///< of pixels that may differ
inline constexpr double kLargestZ = 5; ///< standard errors between block means; 256 of them are compared

HitDifference compare_hits(const Image& a, const Image& b);

/// Largest difference of the mean radiance of any of 16 x 16 blocks, in standard errors. Both pictures need
/// the layer variance, and samples that do not depend on each other.
double compute_largest_z(const Image& a, const Image& b);

struct ParityOptions {
    RenderSettings settings; ///< of the Vulkan engine: device, size, pipeline cache
    int noise_samples = 256; ///< a pixel, of the pictures whose means are compared
    std::vector<std::string> scenes = {"ear", "pumpkin", "bark", "barks", "party"};
    std::string only; ///< part of the names of the cases to run; empty: all
};

/// {cases: [{name, outcome, ...}], passed, failed}: first hits at every level, leaf, form of the bottom
/// kernel, with and without cache, instanced or not; the same bits twice; means of noisy pictures.
Value run_parity(const ParityOptions& options, const bench::Report& report);

} // namespace relief::gpu
