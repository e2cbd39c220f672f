// Points along the lines of a patch that its levels are chosen by.
#pragma once

#include <array>
#include <cstdint>

#include "surface/patch/patch_samples.h"

namespace relief {

inline constexpr int kEdgeSegments = 8;
inline constexpr int kMiddleSegments = 16;

/// Displaced points, object space.
struct LevelLines {
    /// Edge k from its line's start to its end.
    std::array<std::array<Vec3f, kEdgeSegments + 1>, 4> edges;
    /// Along u and along v through the middle, without the ends.
    std::array<std::array<Vec3f, kMiddleSegments - 1>, 2> middles;
};

/// `samples`: of the patch, unfiltered, as the lines are. In SIMD where possible, with the same bits.
LevelLines evaluate_level_lines(const Surface& surface, uint32_t patch, const PatchSamples& samples);

/// The same one by one, which is the definition.
LevelLines evaluate_level_lines(const PatchSamples& samples);

} // namespace relief
