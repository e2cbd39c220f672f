// The lines that levels of patches are chosen by, as arrays of numbers: made once for a surface, measured for
// each object that shows it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surface/patch/level_lines.h"

namespace relief {

/// A displaced line in world space, as far as its level depends on it.
struct LineMeasure {
    double length = 0, radius = 0; ///< of its points; of the sphere about them
    Vec3f center{};
    int cap = 0; ///< the highest level that the map is worth
};

/// The lines that the levels of a patch are chosen by.
struct PatchLines {
    std::array<LineMeasure, 4> edges;
    std::array<LineMeasure, 2> middles; ///< along u and along v
};

/// `Count` points of each of four lines: point k of line n is entry 4 k + n, so that four lines are measured
/// at once.
template <size_t Count> struct FourLines { std::array<float, 4 * Count> x{}, y{}, z{}; };

/// Points of the lines of one patch, object space.
struct LinePoints {
    FourLines<kEdgeSegments + 1> edges;
    FourLines<kMiddleSegments - 1> middles; ///< two; the others are 0
    std::array<uint8_t, 4> edge_caps{};     ///< LineMeasure::cap
    std::array<uint8_t, 2> middle_caps{};
};

LinePoints make_line_points(const Surface& surface, uint32_t patch);

/// One per patch; empty without displacement.
std::vector<LinePoints> list_line_points(const Surface& surface);

PatchLines measure_line_points(const LinePoints& points, const Affine& world_from_object);

} // namespace relief
