#include "surface/patch/level_lines.h"

#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/patch/level_lines.cpp"
#include <hwy/foreach_target.h>

#include "surface/patch/sample_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

constexpr size_t kEdgeLanes = 8; // of two edges that are evaluated at once

/// `count` lanes from `begin`.
HWY_INLINE void store_lanes(const Lanes16 (&position)[3], size_t begin, size_t count, Vec3f* points) {
    alignas(64) float lanes[3][16];
    for (int axis = 0; axis < 3; ++axis) position[axis].store(lanes[axis]);
    for (size_t k = begin; k < begin + count; ++k) *points++ = {lanes[0][k], lanes[1][k], lanes[2][k]};
}

HWY_INLINE void evaluate_middles(const Surface& surface, uint32_t patch, const MapImage& image,
                                 LevelLines& lines) {
    static_assert(kMiddleSegments == 16);
    const PatchValues values(surface, patch);
    const Lanes16 ramp = make_ramp(0) * Lanes16(1.0f / kMiddleSegments), half(0.5f);
    Lanes16 position[3];
    for (const bool is_along_u : {true, false}) {
        evaluate_samples<Spacing::wide>(surface, image, values, is_along_u ? ramp : half,
                                        is_along_u ? half : ramp, position);
        store_lanes(position, 1, kMiddleSegments - 1, lines.middles[is_along_u ? 0 : 1].data());
    }
}

/// What the samples of an edge are interpolated from, and the vertex that displaces the corner of its number.
struct EdgeValues {
    VertexValues first, second, corner;
    std::array<Vec3f, 2> controls;

    HWY_INLINE EdgeValues(const Surface& surface, uint32_t patch, int edge) {
        const Surface::EdgeLine line = surface.edge_line(patch, edge);
        first = read_vertex(surface, line.first), second = read_vertex(surface, line.second);
        corner = read_vertex(surface, surface.dominant(surface.quads[patch].vertex[size_t(edge)]));
        controls = surface.line_controls(patch, edge, line);
    }
};

/// Edges `edge` and `edge` + 1, and the corners of these numbers in the lanes where the lines start, at which
/// only the first value counts.
HWY_INLINE void evaluate_edges(const Surface& surface, uint32_t patch, const MapImage& image, int edge,
                               std::array<Vec3f, 4>& corners, LevelLines& lines) {
    static_assert(kEdgeSegments == kEdgeLanes);
    const EdgeValues low(surface, patch, edge), high(surface, patch, edge + 1);
    const Lanes16 lane = make_ramp(0);
    const auto join = [&](float a, float b)
                          HWY_ATTR { return select_less(lane, Lanes16(8), Lanes16(a), Lanes16(b)); };
    const auto first = [&](int k) HWY_ATTR {
        const Lanes16 a =
            select_less(lane, Lanes16(1), Lanes16(low.corner.value[k]), Lanes16(low.first.value[k]));
        const Lanes16 b =
            select_less(lane, Lanes16(9), Lanes16(high.corner.value[k]), Lanes16(high.first.value[k]));
        return select_less(lane, Lanes16(8), a, b);
    };
    const auto second = [&](int k) HWY_ATTR { return join(low.second.value[k], high.second.value[k]); };
    const auto control = [&](size_t which, int axis) HWY_ATTR {
        return join(get_component(low.controls[which], axis), get_component(high.controls[which], axis));
    };
    const Lanes16 s = select_less(lane, Lanes16(8), lane, lane - Lanes16(8)) * Lanes16(1.0f / kEdgeSegments);
    Lanes16 position[3];
    evaluate_between<Spacing::wide>(surface, image, first, second, control, s, position);
    for (size_t k = 0; k < 2; ++k) {
        store_lanes(position, k * kEdgeLanes, 1, &corners[size_t(edge) + k]);
        store_lanes(position, k * kEdgeLanes + 1, kEdgeSegments - 1,
                    lines.edges[size_t(edge) + k].data() + 1);
    }
}

HWY_INLINE bool has_one_tile(const Surface& surface, uint32_t patch) {
    const Quad quad = surface.quads[patch];
    const TileIndex tile = surface.tile(quad.vertex[0]);
    bool is_same = true;
    for (int k = 0; k < 4; ++k)
        is_same &= surface.tile(surface.edge_line(patch, k).first) == tile &&
                   surface.tile(surface.dominant(quad.vertex[size_t(k)])) == tile;
    return is_same;
}

bool try_evaluate_lines(const Surface& surface, uint32_t patch, std::array<Vec3f, 4>& corners,
                        LevelLines& lines) {
    if (!can_evaluate_wide(surface, patch) || !has_one_tile(surface, patch)) return false;
    const MapImage image{surface.tile(surface.quads[patch].vertex[0]), 0};
    evaluate_middles(surface, patch, image, lines);
    for (const int edge : {0, 2}) evaluate_edges(surface, patch, image, edge, corners, lines);
    return true;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace relief {

HWY_EXPORT(try_evaluate_lines);

namespace {

void add_corners(const PatchSamples& samples, const std::array<Vec3f, 4>& corners, LevelLines& lines) {
    for (int edge = 0; edge < 4; ++edge) {
        lines.edges[size_t(edge)].front() = corners[size_t(samples.line_start(edge))];
        lines.edges[size_t(edge)].back() = corners[size_t(samples.line_end(edge))];
    }
}

} // namespace

LevelLines evaluate_level_lines(const PatchSamples& samples) {
    LevelLines lines;
    std::array<Vec3f, 4> corners;
    for (int k = 0; k < 4; ++k) corners[size_t(k)] = samples.corner(k);
    add_corners(samples, corners, lines);
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
    std::array<Vec3f, 4> corners;
    if (!HWY_DYNAMIC_DISPATCH(try_evaluate_lines)(surface, patch, corners, lines))
        return evaluate_level_lines(samples);
    add_corners(samples, corners, lines);
    return lines;
}

} // namespace relief

#endif
