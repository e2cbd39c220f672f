#include "surface/patch/level_lines.h"

#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/patch/level_lines.cpp"
#include <hwy/foreach_target.h>

#include "surface/patch/sample_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Lanes 1 to `count`.
HWY_INLINE void store_lanes(const Lanes16 (&position)[3], size_t count, Vec3f* points) {
    alignas(64) float lanes[3][16];
    for (int axis = 0; axis < 3; ++axis) position[axis].store(lanes[axis]);
    for (size_t k = 1; k <= count; ++k) points[k - 1] = {lanes[0][k], lanes[1][k], lanes[2][k]};
}

/// All but the corners, of a patch that can_evaluate_wide.
void evaluate_lines(const Surface& surface, uint32_t patch, LevelLines& lines) {
    static_assert(kEdgeSegments <= 16 && kMiddleSegments == 16);
    const PatchValues values(surface, patch);
    const MapImage image{surface.tile(surface.quads[patch].vertex[0]), 0};
    const Lanes16 ramp = make_ramp(0) * Lanes16(1.0f / kMiddleSegments), half(0.5f);
    Lanes16 position[3];
    for (const bool is_along_u : {true, false}) {
        evaluate_samples<Spacing::wide>(surface, image, values, is_along_u ? ramp : half,
                                        is_along_u ? half : ramp, position);
        store_lanes(position, kMiddleSegments - 1, lines.middles[is_along_u ? 0 : 1].data());
    }
    for (int edge = 0; edge < 4; ++edge) {
        const Surface::EdgeLine line = surface.edge_line(patch, edge);
        evaluate_line<Spacing::wide>(surface, line, surface.line_controls(patch, edge, line), 0,
                                     make_ramp(0) * Lanes16(1.0f / kEdgeSegments), position);
        store_lanes(position, kEdgeSegments - 1, lines.edges[size_t(edge)].data() + 1);
    }
}

bool try_evaluate_lines(const Surface& surface, uint32_t patch, LevelLines& lines) {
    if (!can_evaluate_wide(surface, patch)) return false;
    evaluate_lines(surface, patch, lines);
    return true;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace relief {

HWY_EXPORT(try_evaluate_lines);

namespace {

void add_corners(const PatchSamples& samples, LevelLines& lines) {
    std::array<Vec3f, 4> corners;
    for (int k = 0; k < 4; ++k) corners[size_t(k)] = samples.corner(k);
    for (int edge = 0; edge < 4; ++edge) {
        lines.edges[size_t(edge)].front() = corners[size_t(samples.line_start(edge))];
        lines.edges[size_t(edge)].back() = corners[size_t(samples.line_end(edge))];
    }
}

} // namespace

LevelLines evaluate_level_lines(const PatchSamples& samples) {
    LevelLines lines;
    add_corners(samples, lines);
    for (int edge = 0; edge < 4; ++edge)
        for (int k = 1; k < kEdgeSegments; ++k)
            lines.edges[size_t(edge)][size_t(k)] = samples.edge(edge, float(k) / kEdgeSegments);
    for (int k = 1; k < kMiddleSegments; ++k) {
        const float s = float(k) / kMiddleSegments;
        lines.middles[0][size_t(k - 1)] = samples.interior(s, 0.5f);
        lines.middles[1][size_t(k - 1)] = samples.interior(0.5f, s);
    }
    return lines;
}

LevelLines evaluate_level_lines(const Surface& surface, uint32_t patch, const PatchSamples& samples) {
    LevelLines lines;
    if (!HWY_DYNAMIC_DISPATCH(try_evaluate_lines)(surface, patch, lines))
        return evaluate_level_lines(samples);
    add_corners(samples, lines);
    return lines;
}

} // namespace relief

#endif
