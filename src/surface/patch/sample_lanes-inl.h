// Samples of a displaced patch, sixteen at a time, by the operations of evaluate_vertex: the same bits.
#if defined(RELIEF_SAMPLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_SAMPLE_LANES_INL_H
#undef RELIEF_SAMPLE_LANES_INL_H
#else
#define RELIEF_SAMPLE_LANES_INL_H
#endif

#include <algorithm>
#include <optional>

#include "formulas/lanes-inl.h"
#include "surface/map/texel_lanes-inl.h"
#include "surface/map/texels.h"
#include "surface/map/tile_texels.h"
#include "surface/patch/bicubic.h"
#include "surface/patch/surface.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// What is interpolated over a patch or along an edge: position, uv and, in tangent space, the frame.
inline constexpr int kPosition = 0, kUv = 3, kFrame = 5, kValueCount = 14;

struct VertexValues {
    float value[kValueCount];
};

HWY_INLINE VertexValues read_vertex(const Surface& surface, uint32_t vertex) {
    VertexValues values{};
    const Vec3f& p = surface.position(vertex);
    const Vec2f& uv = surface.uvs[vertex];
    values.value[0] = p.x, values.value[1] = p.y, values.value[2] = p.z;
    values.value[kUv] = uv.x, values.value[kUv + 1] = uv.y;
    if (surface.map.is_tangent) {
        const Frame frame = surface.frame(vertex);
        const Vec3f axes[3] = {frame.t, frame.b, frame.n};
        for (int a = 0; a < 3; ++a)
            for (int c = 0; c < 3; ++c) values.value[kFrame + 3 * a + c] = get_component(axes[a], c);
    }
    return values;
}

/// All sixteen in [0, end).
HWY_INLINE bool is_within(const int32_t (&index)[16], int32_t end) {
    bool is_within = true;
    for (int lane = 0; lane < 16; ++lane) is_within &= uint32_t(index[lane]) < uint32_t(end);
    return is_within;
}

/// Image of a map that sixteen samples read.
struct MapImage {
    TileIndex tile;
    uint32_t mip;
};

/// Bilinear value in the cell of texels that begins at (x, y), for maps with tiles beside each other.
HWY_NOINLINE inline Lanes4 fetch_across_tiles(const DisplacementMap& map, const MapImage& image, int64_t x,
                                              int64_t y, float fx, float fy) {
    const Texture& texture = map.image(image.tile, image.mip).texture;
    std::array<float, 4> texels[4];
    for (int k = 0; k < 4; ++k) {
        const int64_t column = x + (k & 1), row = y + (k >> 1);
        texels[k] = is_within_image(texture, {column, column}, {row, row})
                        ? read_channels(texture, column, row)
                        : read_beyond_tile(map, image.tile, image.mip, column, row);
    }
    const hn::FixedTag<float, 4> d;
    Lanes4 t[4];
    for (int k = 0; k < 4; ++k) t[k].part[0] = hn::LoadU(d, texels[k].data());
    return texel::filter_texels(t[0], t[1], t[2], t[3], Lanes4(fx), Lanes4(fy));
}

/// Raw channels r, g, b at sixteen uvs, bilinear.
HWY_INLINE void fetch_raw(const DisplacementMap& map, const MapImage& image, const Lanes16& u,
                          const Lanes16& v, Lanes16 (&raw)[3]) {
    const Texture& texture = map.image(image.tile, image.mip).texture;
    const int32_t width = int32_t(texture.width), height = int32_t(texture.height);
    const Lanes16 half(0.5f);
    const Lanes16 x = u * Lanes16(float(width)) - half;
    const Lanes16 y = (map.flip_v ? v : Lanes16(1.0f) - v) * Lanes16(float(height)) - half;
    const Lanes16 x0 = floor(x), y0 = floor(y);
    alignas(64) int32_t column[16], row[16];
    alignas(64) float fx[16], fy[16], texels[16][4];
    x0.store_as_integers(column), y0.store_as_integers(row);
    (x - x0).store(fx), (y - y0).store(fy);
    // Nearly always nothing has to be wrapped.
    const bool is_inside = is_within(column, width - 1) && is_within(row, height - 1);
    for (int lane = 0; lane < 16; ++lane) {
        size_t left = size_t(column[lane]), right = left + 1;
        size_t top = size_t(row[lane]) * size_t(width), bottom = top + size_t(width);
        if (!is_inside && !map.neighbours.empty()) {
            fetch_across_tiles(map, image, column[lane], row[lane], fx[lane], fy[lane])
                .store_unaligned(texels[lane]);
            continue;
        }
        if (!is_inside) {
            left = size_t(wrap_index(column[lane], width, map.wrap));
            right = size_t(wrap_index(column[lane] + 1, width, map.wrap));
            top = size_t(wrap_index(row[lane], height, map.wrap)) * size_t(width);
            bottom = size_t(wrap_index(row[lane] + 1, height, map.wrap)) * size_t(width);
        }
        const Lanes4 t =
            texel::filter_texels(load_texel(texture, top + left), load_texel(texture, top + right),
                                 load_texel(texture, bottom + left), load_texel(texture, bottom + right),
                                 Lanes4(fx[lane]), Lanes4(fy[lane]));
        t.store_unaligned(texels[lane]);
    }
    using D = Lanes16::D;
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        hn::Vec<D> alpha;
        hn::LoadInterleaved4(D(), &texels[p * Lanes16::kLanes][0], raw[0].part[p], raw[1].part[p],
                             raw[2].part[p], alpha);
    }
}

/// The same where all sixteen lie near each other, as along a row of samples finer than the texels: runs of
/// texels are read once and picked from in registers. False where they do not, or where the map wraps.
HWY_INLINE bool fetch_run(const DisplacementMap& map, const MapImage& image, const Lanes16& u,
                          const Lanes16& v, Lanes16 (&raw)[3]) {
    if constexpr (!LaneTable<16>::kIsInRegisters) return false;
    constexpr float kMostRows = 5; // more of them than that cost as much as texels one by one
    const Texture& texture = map.image(image.tile, image.mip).texture;
    const Lanes16 half(0.5f);
    const Lanes16 x = u * Lanes16(float(texture.width)) - half;
    const Lanes16 y = (map.flip_v ? v : Lanes16(1.0f) - v) * Lanes16(float(texture.height)) - half;
    const Lanes16 x0 = floor(x), y0 = floor(y);
    const float left = reduce_min(x0), top = reduce_min(y0), bottom = reduce_max(y0);
    const bool is_near = reduce_max(x0) - left <= 14 && bottom - top < kMostRows;
    const bool is_inside =
        left >= 0 && top >= 0 && bottom + 1 < float(texture.height) && left + 16 <= float(texture.width);
    if (!(is_near && is_inside)) return false;
    const LaneIndices column = LaneIndices::convert(x0 - Lanes16(left)), next = column + LaneIndices(1);
    const Lanes16 fx = x - x0;
    size_t first = size_t(top) * texture.width + size_t(left);
    const auto blend_row = [&](Lanes16(&row)[3]) HWY_ATTR {
        Lanes16 texels[3];
        load_texels(texture, first, texels);
        first += texture.width;
        for (int c = 0; c < 3; ++c) {
            const LaneTable<16> table(texels[c]);
            row[c] = wide::blend(table.pick(column), table.pick(next), fx);
        }
    };
    Lanes16 above[3], upper[3], lower[3];
    blend_row(above);
    for (float row = top; row <= bottom; ++row) {
        Lanes16 below[3];
        blend_row(below);
        for (int c = 0; c < 3; ++c) {
            upper[c] = row == top ? above[c] : select_less(y0, Lanes16(row), upper[c], above[c]);
            lower[c] = row == top ? below[c] : select_less(y0, Lanes16(row), lower[c], below[c]);
            above[c] = below[c];
        }
    }
    for (int c = 0; c < 3; ++c) raw[c] = wide::blend(upper[c], lower[c], y - y0);
    return true;
}

/// Places of sixteen samples between the texels of an image.
struct TexelLanes {
    Lanes16 x0, y0, fx, fy;

    HWY_INLINE TexelLanes(const DisplacementMap& map, const Texture& texture, const Lanes16& u,
                          const Lanes16& v) {
        const Lanes16 half(0.5f);
        const Lanes16 x = u * Lanes16(float(texture.width)) - half;
        const Lanes16 y = (map.flip_v ? v : Lanes16(1.0f) - v) * Lanes16(float(texture.height)) - half;
        x0 = floor(x), y0 = floor(y);
        fx = x - x0, fy = y - y0;
    }
};

/// The four weights of each lane, lane after lane.
HWY_INLINE void weigh_lanes(const Lanes16& fraction, LaneQuads& weights) {
    const wide::CubicWeights w = wide::weigh_spline(fraction);
    weights.set(w.first, w.second, w.third, w.fourth);
}

HWY_INLINE texel::CubicWeights broadcast_weights(const float (&weights)[4]) {
    return {Lanes4(weights[0]), Lanes4(weights[1]), Lanes4(weights[2]), Lanes4(weights[3])};
}

/// The same as fetch_across_tiles of a smooth map.
HWY_NOINLINE inline void fetch_spline_across_tiles(const DisplacementMap& map, const MapImage& image,
                                                   const std::array<int64_t, 2>& cell, float fx, float fy,
                                                   float* result) {
    const Texture& texture = map.image(image.tile, image.mip).texture;
    const auto read = [&](size_t i, size_t j) {
        const int64_t x = cell[0] + int64_t(i) - 1, y = cell[1] + int64_t(j) - 1;
        return is_within_image(texture, {x, x}, {y, y}) ? read_channels(texture, x, y)
                                                        : read_beyond_tile(map, image.tile, image.mip, x, y);
    };
    const std::array<float, 4> value = filter_spline(read, fx, fy);
    std::copy(value.begin(), value.end(), result);
}

/// Raw channels of a smooth map at sixteen places, texel by texel.
HWY_NOINLINE inline void fetch_spline_raw(const DisplacementMap& map, const MapImage& image,
                                          const TexelLanes& place, Lanes16 (&raw)[3]) {
    const Texture& texture = map.image(image.tile, image.mip).texture;
    const int32_t width = int32_t(texture.width), height = int32_t(texture.height);
    alignas(64) int32_t column[16], row[16];
    place.x0.store_as_integers(column), place.y0.store_as_integers(row);
    LaneQuads along, across, values;
    weigh_lanes(place.fx, along), weigh_lanes(place.fy, across);
    alignas(64) float fractions[2][16];
    place.fx.store(fractions[0]), place.fy.store(fractions[1]);
    // Of large uvs, whose fraction is lost: within integers, as the device has them.
    constexpr int32_t kMost = 1 << 30;
    const auto is_inside_at = [&](int32_t x, int32_t y) {
        return x >= 1 && x + 2 < width && y >= 1 && y + 2 < height;
    };
    for (int lane = 0; lane < 16; ++lane) {
        column[lane] = std::clamp(column[lane], -kMost, kMost),
        row[lane] = std::clamp(row[lane], -kMost, kMost);
        bool is_inside = is_inside_at(column[lane], row[lane]);
        if (!is_inside && !map.neighbours.empty()) {
            fetch_spline_across_tiles(map, image, {column[lane], row[lane]}, fractions[0][lane],
                                      fractions[1][lane], values.lane[lane]);
            continue;
        }
        if (!is_inside && map.wrap == WrapMode::repeat) {
            // Once for all sixteen texels, but at the borders of the map.
            column[lane] = wrap_index(column[lane], width, map.wrap);
            row[lane] = wrap_index(row[lane], height, map.wrap);
            is_inside = is_inside_at(column[lane], row[lane]);
        }
        size_t columns[4], rows[4];
        for (int k = 0; k < 4; ++k) {
            const int32_t x = column[lane] + k - 1, y = row[lane] + k - 1;
            columns[k] = size_t(is_inside ? x : wrap_index(x, width, map.wrap));
            rows[k] = size_t(is_inside ? y : wrap_index(y, height, map.wrap)) * size_t(width);
        }
        const texel_pair::CubicWeights weights = {Lanes8(along.lane[lane][0]), Lanes8(along.lane[lane][1]),
                                                  Lanes8(along.lane[lane][2]), Lanes8(along.lane[lane][3])};
        Lanes4 point[4];
        for (int k = 0; k < 4; k += 2) {
            const auto load = [&](int column) HWY_ATTR {
                return load_texel_pair(texture, rows[k] + columns[column], rows[k + 1] + columns[column]);
            };
            split(texel_pair::blend_cubic(load(0), load(1), load(2), load(3), weights), point[k],
                  point[k + 1]);
        }
        texel::blend_cubic(point[0], point[1], point[2], point[3], broadcast_weights(across.lane[lane]))
            .store_unaligned(values.lane[lane]);
    }
    Lanes16 alpha;
    values.transpose(raw[0], raw[1], raw[2], alpha);
}

/// The same as fetch_run of a smooth map: false where the places are not near each other or the map wraps.
HWY_NOINLINE inline bool fetch_spline_run(const Texture& texture, const TexelLanes& place,
                                          Lanes16 (&raw)[3]) {
    if constexpr (!LaneTable<16>::kIsInRegisters) return false;
    constexpr float kMostRows = 3;
    const float left = reduce_min(place.x0) - 1, top = reduce_min(place.y0), bottom = reduce_max(place.y0);
    const bool is_near = reduce_max(place.x0) - left <= 13 && bottom - top < kMostRows;
    const bool is_inside =
        left >= 0 && top >= 1 && bottom + 2 < float(texture.height) && left + 16 <= float(texture.width);
    if (!(is_near && is_inside)) return false;
    const LaneIndices column = LaneIndices::convert(place.x0 - Lanes16(left));
    const LaneIndices columns[4] = {column + LaneIndices(-1), column, column + LaneIndices(1),
                                    column + LaneIndices(2)};
    const wide::CubicWeights along = wide::weigh_spline(place.fx), across = wide::weigh_spline(place.fy);
    size_t first = size_t(top - 1) * texture.width + size_t(left);
    Lanes16 point[4][3]; // of the rows -1 to 2 of each lane
    for (float row = top - 1; row <= bottom + 2; ++row, first += texture.width) {
        Lanes16 texels[3];
        load_texels(texture, first, texels);
        for (int c = 0; c < 3; ++c) {
            const LaneTable<16> table(texels[c]);
            const Lanes16 value = wide::blend_cubic(table.pick(columns[0]), table.pick(columns[1]),
                                                    table.pick(columns[2]), table.pick(columns[3]), along);
            // Rows come in order, so the last one that is not below a lane's is its own.
            for (int k = 0; k < 4; ++k)
                point[k][c] = row == top - 1 ? value
                                             : select_less(place.y0 + Lanes16(float(k - 1)), Lanes16(row),
                                                           point[k][c], value);
        }
    }
    for (int c = 0; c < 3; ++c)
        raw[c] = wide::blend_cubic(point[0][c], point[1][c], point[2][c], point[3][c], across);
    return true;
}

/// Whether sixteen samples are neighbours of a grid as fine as the picture, or lie all over a patch.
enum class Spacing { close, wide };

/// Raw channels at sixteen uvs, by the map's own filter.
template <Spacing kSpacing>
HWY_INLINE void fetch_channels(const DisplacementMap& map, const MapImage& image, const Lanes16& u,
                               const Lanes16& v, Lanes16 (&raw)[3]) {
    if (map.is_smooth) {
        const Texture& texture = map.image(image.tile, image.mip).texture;
        const TexelLanes place(map, texture, u, v);
        if (kSpacing == Spacing::wide || !fetch_spline_run(texture, place, raw))
            fetch_spline_raw(map, image, place, raw);
        return;
    }
    if (kSpacing == Spacing::wide || !fetch_run(map, image, u, v, raw)) fetch_raw(map, image, u, v, raw);
}

/// Displaced positions of sixteen samples whose interpolated values are given.
template <Spacing kSpacing>
HWY_INLINE void displace(const Surface& surface, const MapImage& image, const Lanes16 (&value)[kValueCount],
                         Lanes16 (&position)[3]) {
    const DisplacementMap& map = surface.map;
    Lanes16 raw[3], d[3];
    fetch_channels<kSpacing>(map, image, value[kUv], value[kUv + 1], raw);
    raw[0] = raw[0] - Lanes16(map.midlevel.x);
    raw[1] = raw[1] - Lanes16(map.midlevel.y);
    raw[2] = raw[2] - Lanes16(map.midlevel.z);
    for (int r = 0; r < 3; ++r)
        d[r] = wide::decode_row(raw[0], raw[1], raw[2], Lanes16(map.matrix[size_t(r)].x),
                                Lanes16(map.matrix[size_t(r)].y), Lanes16(map.matrix[size_t(r)].z));
    for (int c = 0; c < 3; ++c) {
        const Lanes16 offset = map.is_tangent
                                   ? wide::carry_through_frame(d[0], d[1], d[2], value[kFrame + c],
                                                               value[kFrame + 3 + c], value[kFrame + 6 + c])
                                   : d[c];
        position[c] = value[kPosition + c] + offset;
    }
}

HWY_INLINE Lanes16 make_ramp(float begin) {
    alignas(64) static constexpr float kRamp[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return Lanes16(begin) + Lanes16::load(kRamp);
}

/// A patch unpacked for interior samples.
struct PatchValues {
    VertexValues corner[4];
    std::optional<BicubicBase> base; ///< where it is bicubic

    HWY_INLINE PatchValues(const Surface& surface, uint32_t patch) {
        const Quad quad = surface.quads[patch];
        for (size_t k = 0; k < 4; ++k) corner[k] = read_vertex(surface, quad.vertex[k]);
        if (surface.controls.empty()) return;
        base.emplace(std::array<Vec3f, 4>{surface.position(quad.vertex[0]), surface.position(quad.vertex[1]),
                                          surface.position(quad.vertex[2]), surface.position(quad.vertex[3])},
                     surface.controls[patch]);
    }
};

/// One coordinate of sixteen samples of a bicubic base.
HWY_INLINE Lanes16 blend_base(const BicubicBase& base, int axis, const wide::CubicWeights& along,
                              const wide::CubicWeights& across) {
    const auto read = [&](size_t column, size_t row)
                          HWY_ATTR { return Lanes16(get_component(base.columns[column][row], axis)); };
    Lanes16 point[4];
    for (size_t column = 0; column < 4; ++column)
        point[column] =
            wide::blend_cubic(read(column, 0), read(column, 1), read(column, 2), read(column, 3), across);
    return wide::blend_cubic(point[0], point[1], point[2], point[3], along);
}

/// Sixteen samples at (u, v) on a patch, by the formula of interior samples.
template <Spacing kSpacing>
HWY_INLINE void evaluate_samples(const Surface& surface, const MapImage& image, const PatchValues& patch,
                                 const Lanes16& u, const Lanes16& v, Lanes16 (&position)[3]) {
    const int values = surface.map.is_tangent ? kValueCount : kFrame;
    const VertexValues(&corner)[4] = patch.corner;
    Lanes16 value[kValueCount];
    for (int k = patch.base ? kUv : 0; k < values; ++k)
        value[k] = wide::blend_quad(Lanes16(corner[0].value[k]), Lanes16(corner[1].value[k]),
                                    Lanes16(corner[2].value[k]), Lanes16(corner[3].value[k]), u, v);
    if (patch.base) {
        const wide::CubicWeights along = wide::weigh_cubic(u), across = wide::weigh_cubic(v);
        for (int axis = 0; axis < 3; ++axis) value[axis] = blend_base(*patch.base, axis, along, across);
    }
    displace<kSpacing>(surface, image, value, position);
}

/// Sixteen samples of lines at s, whose ends' values, and controls of a bicubic base, are functions of
/// (value) and of (which, axis).
template <Spacing kSpacing, class First, class Second, class Control>
HWY_INLINE void evaluate_between(const Surface& surface, const MapImage& image, const First& first,
                                 const Second& second, const Control& control, const Lanes16& s,
                                 Lanes16 (&position)[3]) {
    const int values = surface.map.is_tangent ? kValueCount : kFrame;
    const bool is_bicubic = !surface.controls.empty();
    Lanes16 value[kValueCount];
    for (int k = is_bicubic ? kUv : 0; k < values; ++k) value[k] = wide::blend(first(k), second(k), s);
    if (is_bicubic) {
        const wide::CubicWeights weights = wide::weigh_cubic(s);
        for (int axis = 0; axis < 3; ++axis)
            value[axis] =
                wide::blend_cubic(first(axis), control(0, axis), control(1, axis), second(axis), weights);
    }
    displace<kSpacing>(surface, image, value, position);
}

/// Sixteen samples of an edge's line from copy `mip` of the map, at s; `controls`: of a bicubic base.
template <Spacing kSpacing>
HWY_INLINE void evaluate_line(const Surface& surface, const Surface::EdgeLine& line,
                              const std::array<Vec3f, 2>& controls, uint32_t mip, const Lanes16& s,
                              Lanes16 (&position)[3]) {
    const VertexValues first = read_vertex(surface, line.first), second = read_vertex(surface, line.second);
    evaluate_between<kSpacing>(
        surface, {surface.tile(line.first), mip}, [&](int k) HWY_ATTR { return Lanes16(first.value[k]); },
        [&](int k) HWY_ATTR { return Lanes16(second.value[k]); },
        [&](size_t which, int axis) HWY_ATTR { return Lanes16(get_component(controls[which], axis)); }, s,
        position);
}

/// A surface whose samples need no exception: displaced by a real tile, and inside the map everywhere.
HWY_INLINE bool can_evaluate_wide(const Surface& surface, uint32_t patch) {
    if (!surface.has_displacement || surface.map.wrap == WrapMode::black) return false;
    if (surface.tile(surface.quads[patch].vertex[0]) == Surface::kNoTile) return false;
    for (int edge = 0; edge < 4; ++edge)
        if (surface.tile(surface.edge_line(patch, edge).first) == Surface::kNoTile) return false;
    return true;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
