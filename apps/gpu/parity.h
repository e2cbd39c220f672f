// Compares the Vulkan engine with the CPU engine on sample scenes.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "relief/image.h"
#include "relief/render.h"

namespace relief::gpu {

/// Compares the first hits of two pictures of the same samples with the layers depth and id.
struct HitDifference {
    size_t pixels = 0;
    size_t one_only = 0;                 ///< hit in one picture only
    size_t other_depth = 0;              ///< hit in both, depth further apart than kLargestDepthDifference
    size_t other_id = 0;                 ///< hit in both at one depth, but different objects
    double largest_depth_difference = 0; ///< relative, over pixels that agree
    double share() const { return double(one_only + other_depth + other_id) / double(pixels); }
};

inline constexpr double kLargestDepthDifference = 1e-4; ///< relative
inline constexpr double kLargestShare = 1e-4;           ///< maximum fraction of differing pixels
inline constexpr double kLargestZ =
    5; ///< maximum difference of block means in standard errors; 256 are compared

HitDifference compare_hits(const Image& a, const Image& b);

/// Largest difference of the mean radiance of any of 16 x 16 blocks, in standard errors. Both pictures need
/// the layer variance and independent samples.
double compute_largest_z(const Image& a, const Image& b);

struct ParityOptions {
    RenderSettings settings; ///< of the Vulkan engine: device, size, pipeline cache
    int noise_samples = 256; ///< per pixel, for the comparison of means
    std::vector<std::string> scenes = {"ear", "pumpkin", "bark", "barks", "party"};
    std::string only; ///< substring of the names of cases to run; empty: all
};

/// {cases: [{name, outcome, ...}], passed, failed}: first hits at every level, leaf kind and form of the
/// patch tree kernels, with and without cache, instanced or not; determinism; means of noisy pictures.
Value run_parity(const ParityOptions& options, const bench::Report& report);

} // namespace relief::gpu
