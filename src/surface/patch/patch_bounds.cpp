// Boxes of displaced patches. A sample is P = sum of w_c (p_c + F_c d) over the corners c with bilinear
// weights, so it lies in the hull of the p_c + F_c D, where D holds every d that the map gives over the
// patch's uvs. A bicubic base lies in the hull of its control points instead of the p_c. All intervals are in
// double precision and widened by the rounding of the float evaluation (u = 2^-24 an operation).
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/check.h"
#include "surface/map/texel_range.h"
#include "surface/map/tile_texels.h"
#include "surface/map/wrapped_range.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr double kUnit = 0x1p-24;       // half an ulp of 1: relative error of a float operation
constexpr double kUnderflow = 0x1p-140; // more than the absolute error of a few operations on denormals
constexpr int kTexelsOfPart = 8;        // parts of a patch are not made smaller than this
constexpr int64_t kFewTexels = 256;     // read themselves, not by blocks of the pyramid
constexpr int kMostParts = 4;           // a side

struct Interval {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void extend(double value) { low = std::min(low, value), high = std::max(high, value); }
    double size() const { return std::max(std::fabs(low), std::fabs(high)); }
    Interval widened(double by) const { return {low - by, high + by}; }
};

Interval operator+(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }
/// Without a branch: the signs of frames are unpredictable.
Interval operator*(const Interval& a, double b) {
    const double from_low = a.low * b, from_high = a.high * b;
    return {std::min(from_low, from_high), std::max(from_low, from_high)};
}

/// A vertex in double precision.
struct CornerFrame {
    std::array<double, 3> position;
    std::array<std::array<double, 3>, 3> frame{}; // [coordinate][t, b, n]
    std::array<double, 2> uv;
};

CornerFrame make_corner(const VertexData& vertex) {
    const Vec3f &p = vertex.position, &t = vertex.frame.t, &b = vertex.frame.b, &n = vertex.frame.n;
    CornerFrame corner;
    corner.position = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; ++axis)
        corner.frame[axis] = {get_component(t, axis), get_component(b, axis), get_component(n, axis)};
    corner.uv = {vertex.uv.x, vertex.uv.y};
    return corner;
}

/// Without frames where the map does not displace through them.
CornerFrame blend_line(const CornerFrame& a, const CornerFrame& b, double s, bool is_tangent) {
    const auto blend = [s](double x, double y) { return x * (1 - s) + y * s; };
    CornerFrame corner;
    for (int axis = 0; axis < 3; ++axis) {
        corner.position[axis] = blend(a.position[axis], b.position[axis]);
        for (int k = 0; k < 3 && is_tangent; ++k)
            corner.frame[axis][k] = blend(a.frame[axis][k], b.frame[axis][k]);
    }
    for (int k = 0; k < 2; ++k) corner.uv[k] = blend(a.uv[k], b.uv[k]);
    return corner;
}

/// What the displacement by one image is bounded with, and the sizes that rounding errors grow with.
struct Footprint {
    const DisplacementMap* map;
    TileIndex tile;
    uint8_t mip;
    double largest_position = 0, largest_u = 0, largest_v = 0;

    void include(const Vec3f& p) {
        for (const float value : {p.x, p.y, p.z})
            largest_position = std::max(largest_position, double(std::fabs(value)));
    }
    void include(const VertexData& vertex) {
        include(vertex.position);
        largest_u = std::max(largest_u, double(std::fabs(vertex.uv.x)));
        largest_v = std::max(largest_v, double(std::fabs(vertex.uv.y)));
    }
};

/// Texels [first, last] that fetches read between two local coordinates: bilinear ones the two beside a
/// place, a spline two on each side.
std::array<int64_t, 2> find_texels(const Interval& coordinate, double largest, double size, bool is_smooth) {
    const double slack = 16 * kUnit * ((1 + largest) * size + 1);
    const int64_t further = is_smooth ? 1 : 0;
    return {int64_t(std::floor(coordinate.low * size - 0.5 - slack)) - further,
            int64_t(std::floor(coordinate.high * size - 0.5 + slack)) + 1 + further};
}

void extend(ChannelRange& range, const ChannelRange& by) {
    for (size_t c = 0; c < 3; ++c) {
        range.low[c] = std::min(range.low[c], by.low[c]);
        range.high[c] = std::max(range.high[c], by.high[c]);
    }
}

/// Raw channel range of texels of one image: from texels if few, as the pyramid's blocks would widen it.
ChannelRange find_image_range(const DisplacementMap::ImageView& image, const TexelRectangle& texels) {
    const uint64_t count = uint64_t(texels.x1 - texels.x0 + 1) * (texels.y1 - texels.y0 + 1);
    if (count <= kFewTexels)
        if (const auto range = find_texel_range(image.texture, texels)) return *range;
    return image.pyramid.query(texels.x0, texels.y0, texels.x1, texels.y1, WrapMode::clamp, {});
}

/// Raw channel range of a rectangle in the grid of a footprint's image, which the map continues.
ChannelRange find_range(const Footprint& footprint, const std::array<int64_t, 2>& columns,
                        const std::array<int64_t, 2>& rows) {
    const DisplacementMap& map = *footprint.map;
    const DisplacementMap::ImageView image = map.image(footprint.tile, footprint.mip);
    const std::array<float, 3> middle = {map.midlevel.x, map.midlevel.y, map.midlevel.z};
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ChannelRange range{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    if (!map.neighbours.empty() && !is_within_image(image.texture, columns, rows)) {
        const TileRanges ranges = find_tile_ranges(map, footprint.tile, footprint.mip, columns, rows);
        if (ranges.is_outside_read) extend(range, {middle, middle});
        for (const TileRange& part : ranges.parts)
            extend(range, find_image_range(map.image(part.tile, footprint.mip), part.texels));
        return range;
    }
    if ((columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1) > kFewTexels)
        return image.pyramid.query(columns[0], rows[0], columns[1], rows[1], map.wrap, middle);
    const WrappedRange x = wrap_range(columns[0], columns[1], image.texture.width, map.wrap),
                       y = wrap_range(rows[0], rows[1], image.texture.height, map.wrap);
    if (x.is_outside_read || y.is_outside_read) extend(range, {middle, middle});
    for (int j = 0; j < y.count; ++j)
        for (int i = 0; i < x.count; ++i) {
            const auto& [x0, x1] = x.parts[size_t(i)];
            const auto& [y0, y1] = y.parts[size_t(j)];
            extend(range, find_image_range(image, {uint32_t(x0), uint32_t(y0), uint32_t(x1), uint32_t(y1)}));
        }
    return range;
}

/// Interval of each channel of d over a rectangle of uv.
std::array<Interval, 3> bound_displacement(const Footprint& footprint, const Interval& u, const Interval& v) {
    const DisplacementMap& map = *footprint.map;
    const Interval nothing{0, 0};
    if (footprint.tile >= map.tiles.size()) return {nothing, nothing, nothing};
    const DisplacementMap::ImageView image = map.image(footprint.tile, footprint.mip);
    const Interval row = map.flip_v ? v : Interval{1 - v.high, 1 - v.low};
    const auto columns = find_texels(u, footprint.largest_u, image.texture.width, map.is_smooth);
    const auto rows = find_texels(row, footprint.largest_v, image.texture.height, map.is_smooth);
    const std::array<float, 3> middle = {map.midlevel.x, map.midlevel.y, map.midlevel.z};
    const ChannelRange range = find_range(footprint, columns, rows);
    std::array<Interval, 3> values;
    for (int c = 0; c < 3; ++c) {
        const Interval raw{range.low[c], range.high[c]};
        // Weights of a spline err by 10 units together, and each of its two blends by 3 more; texels of a
        // tile of another size have been filtered before.
        const double units = (map.is_smooth ? 32 : 8) + (map.neighbours.empty() ? 0 : 8);
        const Interval filtered = raw.widened(units * kUnit * raw.size() + kUnderflow);
        const Interval value{filtered.low - middle[c], filtered.high - middle[c]};
        values[c] = value.widened(kUnit * value.size() + kUnderflow);
    }
    std::array<Interval, 3> result;
    for (int k = 0; k < 3; ++k) {
        const std::array<double, 3> factors = {map.matrix[k].x, map.matrix[k].y, map.matrix[k].z};
        Interval sum = nothing;
        double size = 0;
        for (int c = 0; c < 3; ++c) {
            sum = sum + values[c] * factors[c];
            size += values[c].size() * std::fabs(factors[c]);
        }
        result[k] = sum.widened(4 * kUnit * size + kUnderflow);
    }
    return result;
}

/// Of one coordinate over `corners` of p, or of `base` where that is not null, plus D or F D.
Interval find_hull(const CoordinateRanges* base, std::span<const CornerFrame> corners, int axis,
                   const std::array<Interval, 3>& d, bool is_tangent) {
    Interval hull;
    if (base) hull = {(*base)[size_t(axis)][0], (*base)[size_t(axis)][1]};
    if (!is_tangent) {
        // Rounding keeps the order, so that the sums may be taken last.
        for (size_t k = 0; k < corners.size() && !base; ++k) hull.extend(corners[k].position[axis]);
        return hull + d[axis];
    }
    Interval all;
    for (const CornerFrame& corner : corners) {
        Interval moved = base ? hull : Interval{corner.position[axis], corner.position[axis]};
        for (int k = 0; k < 3; ++k) moved = moved + d[k] * corner.frame[axis][k];
        all.extend(moved.low), all.extend(moved.high);
    }
    return all;
}

/// Extends `bounds` by the hull over `corners` of p + F D, or of `base` plus F D where that is not null.
void extend_by_hull(std::array<Interval, 3>& bounds, const Footprint& footprint, const CoordinateRanges* base,
                    std::span<const CornerFrame> corners) {
    Interval u, v;
    for (const CornerFrame& corner : corners) u.extend(corner.uv[0]), v.extend(corner.uv[1]);
    const std::array<Interval, 3> d = bound_displacement(footprint, u, v);
    // Blends of frames err by 8 units of their largest entry, not of the value.
    double size = 0;
    for (const Interval& channel : d) size += channel.size() * footprint.map->longest_axis;
    // A cubic is blended twice, each time with 6 units.
    const double slack = 16 * kUnit * (footprint.largest_position + size) + kUnderflow;
    for (int axis = 0; axis < 3; ++axis) {
        const Interval hull = find_hull(base, corners, axis, d, footprint.map->is_tangent);
        bounds[axis].extend(hull.low - slack), bounds[axis].extend(hull.high + slack);
    }
}

/// The patch's own corners and its base.
struct PatchBase {
    Footprint footprint;
    std::array<CornerFrame, 4> corners;
    const BicubicBase* bicubic; ///< or null

    PatchBase(const Surface& surface, const PatchSamples& samples)
        : footprint{&surface.map, samples.corners()[0].tile, samples.corners()[0].mip},
          bicubic(samples.base()) {
        for (int k = 0; k < 4; ++k) {
            footprint.include(samples.corners()[k]);
            corners[k] = make_corner(samples.corners()[k]);
        }
        if (!bicubic) return;
        for (const auto& column : bicubic->columns)
            for (const Vec3f& control : column) footprint.include(control);
    }
};

/// Extends `bounds` by all samples in [u0, u1] x [v0, v1] of a patch that are not on foreign lines.
void extend_by_part(std::array<Interval, 3>& bounds, const PatchBase& base,
                    const std::array<double, 4>& u0_v0_u1_v1) {
    const auto [u0, v0, u1, v1] = u0_v0_u1_v1;
    const std::array<CornerFrame, 4>& corners = base.corners;
    const bool is_tangent = base.footprint.map->is_tangent;
    const auto blend = [&](double u, double v) {
        return blend_line(blend_line(corners[0], corners[1], u, is_tangent),
                          blend_line(corners[3], corners[2], u, is_tangent), v, is_tangent);
    };
    const std::array<CornerFrame, 4> part = {blend(u0, v0), blend(u1, v0), blend(u1, v1), blend(u0, v1)};
    if (!base.bicubic) return extend_by_hull(bounds, base.footprint, nullptr, part);
    const CoordinateRanges ranges = bound_part(*base.bicubic, u0_v0_u1_v1);
    extend_by_hull(bounds, base.footprint, &ranges, part);
}

/// Extends `bounds` by the samples of edge k between s0 and s1 of its line.
void extend_by_line(std::array<Interval, 3>& bounds, const PatchSamples& samples, const DisplacementMap& map,
                    int k, const std::array<double, 2>& s0_s1) {
    Footprint footprint{&map, samples.first_of_line(k).tile, samples.first_of_line(k).mip};
    footprint.include(samples.first_of_line(k)), footprint.include(samples.second_of_line(k));
    const CornerFrame first = make_corner(samples.first_of_line(k)),
                      second = make_corner(samples.second_of_line(k));
    const std::array<CornerFrame, 2> ends = {blend_line(first, second, s0_s1[0], map.is_tangent),
                                             blend_line(first, second, s0_s1[1], map.is_tangent)};
    if (!samples.base()) return extend_by_hull(bounds, footprint, nullptr, ends);
    const std::array<Vec3f, 2>& inner = samples.line_controls(k);
    for (const Vec3f& control : inner) footprint.include(control);
    const CoordinateRanges ranges = bound_curve(
        {samples.first_of_line(k).position, inner[0], inner[1], samples.second_of_line(k).position}, s0_s1);
    extend_by_hull(bounds, footprint, &ranges, ends);
}

/// Parts a side, so that slopes and turning frames do not make the box loose.
int choose_part_count(const Footprint& footprint, const std::array<VertexData, 4>& corners) {
    const DisplacementMap& map = *footprint.map;
    if (footprint.tile >= map.tiles.size()) return 1;
    const Texture& texture = map.image(footprint.tile, footprint.mip).texture;
    Interval u, v;
    for (const VertexData& corner : corners) u.extend(corner.uv.x), v.extend(corner.uv.y);
    const double texels = std::max((u.high - u.low) * texture.width, (v.high - v.low) * texture.height);
    return int(std::clamp(std::ceil(texels / kTexelsOfPart), 1.0, double(kMostParts)));
}

Box round_outward(const std::array<Interval, 3>& bounds) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        float low = float(bounds[axis].low), high = float(bounds[axis].high);
        if (low > bounds[axis].low) low = std::nextafter(low, -kInfinity);
        if (high < bounds[axis].high) high = std::nextafter(high, kInfinity);
        set_component(box.lower, axis, low);
        set_component(box.upper, axis, high);
    }
    return box;
}

Box compute_plain_box(const Surface& surface, uint32_t patch) {
    Box box;
    for (const uint32_t vertex : surface.quads[patch].vertex) box.extend(surface.position(vertex));
    return box;
}

/// Bounds cells of a displaced patch.
Box bound_cells(const DisplacementMap& map, const PatchSamples& samples, const PatchBase& own,
                const PatchLevels& levels, const Cells& cells_i0_j0_i1_j1) {
    const auto [i0, j0, i1, j1] = cells_i0_j0_i1_j1;
    const uint32_t n = 1u << levels.patch;
    const double step = 1.0 / n;
    std::array<Interval, 3> bounds;
    extend_by_part(bounds, own, {i0 * step, j0 * step, i1 * step, j1 * step});
    Box corner_box;
    const bool is_touched[4] = {j0 == 0, i1 == n, j1 == n, i0 == 0};
    const uint32_t starts[4] = {i0, j0, n - i1, n - j1}, ends[4] = {i1, j1, n - i0, n - j0};
    for (int k = 0; k < 4; ++k) {
        if (!is_touched[k]) continue;
        const bool is_reversed = samples.is_line_reversed(k);
        const uint32_t first = is_reversed ? n - ends[k] : starts[k],
                       last = is_reversed ? n - starts[k] : ends[k];
        const uint32_t moved_first = move_edge_sample(first, levels.patch, levels.edge[k]);
        const uint32_t moved_last = move_edge_sample(last, levels.patch, levels.edge[k]);
        if (moved_first == 0) corner_box.extend(samples.corner(samples.line_start(k)));
        if (moved_last == n) corner_box.extend(samples.corner(samples.line_end(k)));
        // Samples that stay where they are lie on the boundary of the part.
        if (samples.is_line_foreign(k) || moved_first != first || moved_last != last)
            extend_by_line(bounds, samples, map, k, {moved_first * step, moved_last * step});
    }
    Box box = round_outward(bounds);
    box.extend(corner_box);
    return box;
}

} // namespace

Box compute_patch_box(const Surface& surface, uint32_t patch) {
    if (!surface.has_displacement) return compute_plain_box(surface, patch);
    const PatchSamples samples(surface, patch);
    const PatchBase own(surface, samples);
    std::array<Interval, 3> bounds;
    const int count = choose_part_count(own.footprint, samples.corners());
    for (int j = 0; j < count; ++j)
        for (int i = 0; i < count; ++i)
            extend_by_part(
                bounds, own,
                {double(i) / count, double(j) / count, double(i + 1) / count, double(j + 1) / count});
    for (int k = 0; k < 4; ++k)
        if (samples.is_line_foreign(k)) extend_by_line(bounds, samples, surface.map, k, {0, 1});
    Box box = round_outward(bounds);
    for (int k = 0; k < 4; ++k)
        if (samples.is_corner_foreign(k)) box.extend(samples.corner(k));
    return box;
}

void compute_tile_boxes(const Surface& surface, uint32_t patch, const PatchLevels& levels,
                        std::span<const Cells> parts, std::span<Box> boxes) {
    DCHECK(boxes.size() == parts.size());
    if (!surface.has_displacement) {
        std::ranges::fill(boxes, compute_plain_box(surface, patch));
        return;
    }
    const PatchSamples samples(surface, patch);
    const PatchBase own(surface, samples);
    for (size_t k = 0; k < parts.size(); ++k)
        boxes[k] = bound_cells(surface.map, samples, own, levels, parts[k]);
}

Box compute_tile_box(const Surface& surface, uint32_t patch, const PatchLevels& levels, const Cells& part) {
    Box box;
    compute_tile_boxes(surface, patch, levels, {&part, 1}, {&box, 1});
    return box;
}

} // namespace relief
