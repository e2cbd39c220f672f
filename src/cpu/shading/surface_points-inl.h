// Surface points of sixteen hits on displaced patches: bit-identical to Tracer::make_surface_point.
#pragma once

#include <cstring>

#include "cpu/patch_trees/patch_evaluation-inl.h"
#include "cpu/shading/shading_kernels.h"
#include "formulas/control_points.h"
#include "formulas/levels.h"
#include "formulas/local_start.h"
#include "formulas/mips.h"
#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

using WideVec2 = wide::Vec2;
using WideVec3 = wide::Vec3;

static_assert(sizeof(VertexData) == 64 && offsetof(VertexData, uv) == 4 * kUv &&
              offsetof(VertexData, frame) == 4 * kFrame);
static_assert(sizeof(Affine) == 48 && sizeof(InnerControls) == 9 * 16);

/// What sixteen hits bring, lane by lane.
struct HitLanes {
    LaneQuads corner[4][4]; ///< VertexData of the patch's corners, four floats a part
    LaneQuads controls[9];  ///< InnerControls, four floats a part, where the base is bicubic
    LaneQuads world_from_object[3], object_from_origin[3]; ///< Affine
    alignas(64) float u[16], v[16], i[16], j[16], side[16], normal_side[16], turn[16], share_of_place[16];
    alignas(64) float is_upper[16], is_seam[4][16]; ///< not 0: true
    alignas(64) float vertex_u[3][16], vertex_v[3][16];
    alignas(64) float foreign[3][3][16]; ///< vertex, axis: where the vertex is not the patch's own
    LaneMask is_foreign[3];

    /// What no hit is loaded into stays without divisions by 0.
    RELIEF_INLINE void clear() {
        std::memset(this, 0, sizeof *this);
        for (size_t lane = 0; lane < 16; ++lane) side[lane] = normal_side[lane] = 1;
    }
};

RELIEF_INLINE void load_quads(const void* source, size_t lane, LaneQuads* quads, size_t count) {
    for (size_t q = 0; q < count; ++q)
        std::memcpy(quads[q].lane[lane], static_cast<const char*>(source) + 16 * q, 16);
}

/// One of the three vertices of a micro-triangle.
struct CellVertex {
    uint32_t number;
    scalar::GridSample at;
};

/// Place of one vertex of a cell; its position at once on a line or at another patch's corner.
inline void load_cell_vertex(const PatchSamples& samples, const PatchLevels& levels, const CellVertex& vertex,
                             size_t lane, HitLanes& lanes) {
    const auto& [number, at] = vertex;
    const uint32_t n = 1u << levels.patch, edge = scalar::find_sample_edge(at.i, at.j, levels.patch);
    bool is_foreign = false;
    scalar::GridSample moved = at;
    if (edge < 4) {
        const uint32_t reversed = samples.is_line_reversed(int(edge)) ? 1u << edge : 0u;
        moved = scalar::move_boundary_sample(at.i, at.j, levels.patch, edge,
                                             uint32_t(levels.patch - levels.edge[edge]), reversed);
        is_foreign = samples.is_line_foreign(int(edge));
    }
    const bool is_left = moved.i == 0, is_low = moved.j == 0;
    if ((is_left || moved.i == n) && (is_low || moved.j == n))
        is_foreign = samples.is_corner_foreign(is_low ? (is_left ? 0 : 1) : (is_left ? 3 : 2));
    const float step = 1.0f / float(n);
    lanes.vertex_u[number][lane] = float(moved.i) * step,
    lanes.vertex_v[number][lane] = float(moved.j) * step;
    if (!is_foreign) return;
    const Vec3f p = evaluate_vertex(samples, levels, at.i, at.j);
    lanes.is_foreign[number] |= LaneMask(1) << lane;
    lanes.foreign[number][0][lane] = p.x, lanes.foreign[number][1][lane] = p.y;
    lanes.foreign[number][2][lane] = p.z;
}

/// Where on its patch, and in the world, a hit is.
RELIEF_INLINE void load_place(const Instance& instance, const cpu::TraceHit& hit, const PatchLevels& levels,
                              size_t lane, HitLanes& lanes) {
    load_quads(&instance.world_from_object, lane, lanes.world_from_object, 3);
    load_quads(&instance.object_space.from_origin, lane, lanes.object_from_origin, 3);
    lanes.u[lane] = hit.u, lanes.v[lane] = hit.v;
    lanes.i[lane] = hit.i, lanes.j[lane] = hit.j;
    lanes.side[lane] = float(1u << levels.patch);
    lanes.turn[lane] = instance.is_mirrored ? -1.0f : 1.0f;
    lanes.share_of_place[lane] = scalar::share_of_place(instance.object_space.origin);
    lanes.is_upper[lane] = hit.is_upper ? 1.0f : 0.0f;
}

inline void load_hit(const cpu::PointBatch& batch, const cpu::TraceHit& hit, size_t lane, HitLanes& lanes) {
    const Instance& instance = batch.scene.instances[hit.instance];
    const Surface& surface = batch.scene.surfaces[instance.surface];
    const PatchSamples& samples = batch.patches.get(surface, hit.patch);
    for (size_t k = 0; k < 4; ++k) load_quads(&samples.corners()[k], lane, lanes.corner[k], 4);
    if (!surface.controls.empty()) load_quads(&surface.controls[hit.patch], lane, lanes.controls, 9);
    const PatchLevels levels = unpack_levels(hit.levels);
    load_place(instance, hit, levels, lane, lanes);
    lanes.normal_side[lane] =
        float(1u << scalar::choose_normal_level(surface.packed_mips(hit.patch), levels.patch));
    for (int edge = 0; edge < 4; ++edge)
        lanes.is_seam[edge][lane] = surface.is_seam(hit.patch, edge) ? 1.0f : 0.0f;
    const uint32_t i = hit.i, j = hit.j;
    load_cell_vertex(samples, levels, {0, {i, j}}, lane, lanes);
    load_cell_vertex(samples, levels, {1, {i + 1, j + (hit.is_upper ? 1u : 0u)}}, lane, lanes);
    load_cell_vertex(samples, levels, {2, {i + (hit.is_upper ? 0u : 1u), j + 1}}, lane, lanes);
}

/// Bicubic bases of sixteen patches.
struct BaseLanes {
    Lanes16 control[16][3]; ///< by number (formulas/control_points.h) and axis

    RELIEF_INLINE void load(const HitLanes& lanes, const Lanes16 (&corners)[4][16]) {
        Lanes16 inner[36];
        for (int q = 0; q < 9; ++q)
            lanes.controls[q].transpose(inner[4 * q], inner[4 * q + 1], inner[4 * q + 2], inner[4 * q + 3]);
        for (int k = 0; k < 16; ++k)
            for (int axis = 0; axis < 3; ++axis)
                control[k][axis] = k < 4 ? corners[k][kPosition + axis] : inner[3 * (k - 4) + axis];
    }
    RELIEF_INLINE const Lanes16& at(uint32_t column, uint32_t row, int axis) const {
        return control[scalar::find_control_point(column, row)][axis];
    }
    RELIEF_INLINE WideVec3 evaluate(const WideVec2& place) const {
        const wide::CubicWeights along = wide::weigh_cubic(place.x), across = wide::weigh_cubic(place.y);
        Lanes16 result[3];
        for (int axis = 0; axis < 3; ++axis) {
            Lanes16 point[4];
            for (uint32_t c = 0; c < 4; ++c)
                point[c] =
                    wide::blend_cubic(at(c, 0, axis), at(c, 1, axis), at(c, 2, axis), at(c, 3, axis), across);
            result[axis] = wide::blend_cubic(point[0], point[1], point[2], point[3], along);
        }
        return {result[0], result[1], result[2]};
    }
    /// Along u, or v.
    template <bool kIsAlongU> RELIEF_INLINE WideVec3 differentiate(const WideVec2& place) const {
        const wide::CubicWeights across = wide::weigh_cubic(kIsAlongU ? place.y : place.x);
        Lanes16 result[3];
        for (int axis = 0; axis < 3; ++axis) {
            Lanes16 d[3];
            for (uint32_t k = 0; k < 3; ++k) {
                const auto step = [&](uint32_t other) HWY_ATTR {
                    return kIsAlongU ? at(k + 1, other, axis) - at(k, other, axis)
                                     : at(other, k + 1, axis) - at(other, k, axis);
                };
                d[k] = wide::blend_cubic(step(0), step(1), step(2), step(3), across);
            }
            result[axis] = wide::blend_slope(d[0], d[1], d[2], kIsAlongU ? place.x : place.y);
        }
        return {result[0], result[1], result[2]};
    }
};

/// Corners of sixteen patches, and what is interpolated between them.
struct CornerLanes {
    Lanes16 value[4][16];
    bool is_bicubic;
    BaseLanes base; ///< where it is bicubic

    RELIEF_INLINE CornerLanes(const HitLanes& lanes, const Surface& surface)
        : is_bicubic(!surface.controls.empty()) {
        for (int k = 0; k < 4; ++k)
            for (int q = 0; q < 4; ++q)
                lanes.corner[k][q].transpose(value[k][4 * q], value[k][4 * q + 1], value[k][4 * q + 2],
                                             value[k][4 * q + 3]);
        if (is_bicubic) base.load(lanes, value);
    }
    RELIEF_INLINE WideVec3 blend_position(const WideVec2& at) const {
        return is_bicubic ? base.evaluate(at) : blend_vector(kPosition, at);
    }
    RELIEF_INLINE Lanes16 blend(int k, const WideVec2& at) const {
        return wide::blend_quad(value[0][k], value[1][k], value[2][k], value[3][k], at.x, at.y);
    }
    RELIEF_INLINE WideVec3 blend_vector(int k, const WideVec2& at) const {
        return {blend(k, at), blend(k + 1, at), blend(k + 2, at)};
    }
    RELIEF_INLINE WideVec3 vector(int corner, int k) const {
        return {value[corner][k], value[corner][k + 1], value[corner][k + 2]};
    }
    /// Difference of a vector from corner a to b and, far away, from c to d.
    RELIEF_INLINE WideVec3 blend_difference(int k, const int (&abcd)[4], const Lanes16& s) const {
        return wide::blend_difference(vector(abcd[0], k), vector(abcd[1], k), vector(abcd[2], k),
                                      vector(abcd[3], k), s);
    }
};

/// Map of the sixteen patches: the image inside of them, and the one that their normals read.
struct MapLanes {
    const DisplacementMap& map;
    MapImage inside, normals;
};

/// Decoded displacement at a place of each patch.
RELIEF_INLINE WideVec3 fetch_decoded(const DisplacementMap& map, const MapImage& image,
                                     const CornerLanes& corners, const WideVec2& at) {
    Lanes16 raw[3];
    fetch_channels<Spacing::wide>(map, image, corners.blend(kUv, at), corners.blend(kUv + 1, at), raw);
    raw[0] = raw[0] - Lanes16(map.midlevel.x);
    raw[1] = raw[1] - Lanes16(map.midlevel.y);
    raw[2] = raw[2] - Lanes16(map.midlevel.z);
    const auto decode = [&](size_t r) HWY_ATTR {
        return wide::decode_row(raw[0], raw[1], raw[2], Lanes16(map.matrix[r].x), Lanes16(map.matrix[r].y),
                                Lanes16(map.matrix[r].z));
    };
    return {decode(0), decode(1), decode(2)};
}

RELIEF_INLINE WideVec3 evaluate_own_vertex(const MapLanes& from, const CornerLanes& corners,
                                           const WideVec2& at) {
    const WideVec3 base = corners.blend_position(at), d = fetch_decoded(from.map, from.inside, corners, at);
    if (!from.map.is_tangent) return base + d;
    const WideVec3 t = corners.blend_vector(kFrame, at), b = corners.blend_vector(kFrame + 3, at),
                   n = corners.blend_vector(kFrame + 6, at);
    return {base.x + wide::carry_through_frame(d.x, d.y, d.z, t.x, b.x, n.x),
            base.y + wide::carry_through_frame(d.x, d.y, d.z, t.y, b.y, n.y),
            base.z + wide::carry_through_frame(d.x, d.y, d.z, t.z, b.z, n.z)};
}

RELIEF_INLINE WideVec3 evaluate_cell_vertex(const HitLanes& lanes, const MapLanes& from,
                                            const CornerLanes& corners, int vertex) {
    const WideVec3 own = evaluate_own_vertex(
        from, corners, {Lanes16::load(lanes.vertex_u[vertex]), Lanes16::load(lanes.vertex_v[vertex])});
    LaneMask which = lanes.is_foreign[vertex];
    if (which == 0) return own;
    alignas(64) float p[3][16];
    own.x.store(p[0]), own.y.store(p[1]), own.z.store(p[2]);
    for (; which != 0; which &= which - 1) {
        const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(which);
        for (int axis = 0; axis < 3; ++axis) p[axis][lane] = lanes.foreign[vertex][axis][lane];
    }
    return {Lanes16::load(p[0]), Lanes16::load(p[1]), Lanes16::load(p[2])};
}

struct AffineLanes {
    WideVec3 rows[3], translation;

    RELIEF_INLINE explicit AffineLanes(const LaneQuads (&quads)[3]) {
        quads[0].transpose(rows[0].x, rows[0].y, rows[0].z, rows[1].x);
        quads[1].transpose(rows[1].y, rows[1].z, rows[2].x, rows[2].y);
        quads[2].transpose(rows[2].z, translation.x, translation.y, translation.z);
    }
    RELIEF_INLINE WideVec3 transform_vector(const WideVec3& v) const {
        return {wide::dot(rows[0], v), wide::dot(rows[1], v), wide::dot(rows[2], v)};
    }
};

struct CellPointLanes {
    wide::TrianglePoint triangle;
    Lanes16 position_error;
};

/// Of the triangles a, b, c of sixteen cells; `uv_area`: their share of the patch's (u, v).
RELIEF_INLINE CellPointLanes make_cell_point(const HitLanes& lanes, const WideVec3& a, const WideVec3& b,
                                             const WideVec3& c, const Lanes16& uv_area) {
    const Lanes16 side = Lanes16::load(lanes.side);
    const wide::Bool is_upper = wide::is_set(lanes.is_upper);
    const wide::CornerWeights weights =
        wide::weigh_cell_corners({Lanes16::load(lanes.u), Lanes16::load(lanes.v)},
                                 {Lanes16::load(lanes.i), Lanes16::load(lanes.j)}, is_upper, side);
    const AffineLanes m(lanes.world_from_object);
    const WideVec3 edge_b = m.transform_vector(b - a), edge_c = m.transform_vector(c - a);
    CellPointLanes point;
    point.triangle =
        wide::make_triangle_point(m.transform_vector(wide::blend_corners(a, b, c, weights)) + m.translation,
                                  edge_b, edge_c, Lanes16::load(lanes.turn), uv_area);
    const Lanes16 corner = wide::max(wide::max(wide::largest_coordinate(a), wide::largest_coordinate(b)),
                                     wide::largest_coordinate(c));
    const Lanes16 row = wide::max(wide::max(wide::sum_magnitudes(m.rows[0]), wide::sum_magnitudes(m.rows[1])),
                                  wide::sum_magnitudes(m.rows[2]));
    point.position_error = wide::bound_position_error(corner, row, wide::largest_coordinate(m.translation),
                                                      wide::largest_coordinate(point.triangle.position),
                                                      Lanes16::load(lanes.share_of_place));
    point.triangle.position =
        wide::leave_edges(point.triangle.position, point.position_error, weights, edge_b, edge_c,
                          point.triangle.area_per_uv * uv_area * Lanes16(2.0f));
    return point;
}

RELIEF_INLINE wide::SurfaceDerivative differentiate(const MapLanes& from, const CornerLanes& corners,
                                                    const int (&abcd)[4], const Lanes16& s) {
    wide::SurfaceDerivative along{};
    along.base = corners.blend_difference(kPosition, abcd, s);
    if (from.map.is_tangent)
        along.frame = {corners.blend_difference(kFrame, abcd, s),
                       corners.blend_difference(kFrame + 3, abcd, s),
                       corners.blend_difference(kFrame + 6, abcd, s)};
    return along;
}

/// compute_shading_normal (surface/patch/shading_normal.cpp) of each lane.
RELIEF_INLINE WideVec3 compute_shading_normals(const HitLanes& lanes, const MapLanes& from,
                                               const CornerLanes& corners) {
    const WideVec2 at{Lanes16::load(lanes.u), Lanes16::load(lanes.v)};
    wide::SurfaceDerivative along_u = differentiate(from, corners, {0, 1, 3, 2}, at.y);
    wide::SurfaceDerivative along_v = differentiate(from, corners, {0, 3, 1, 2}, at.x);
    if (corners.is_bicubic)
        along_u.base = corners.base.differentiate<true>(at),
        along_v.base = corners.base.differentiate<false>(at);
    const Lanes16 zero(0.0f), half_cell = Lanes16(0.5f) / Lanes16::load(lanes.normal_side);
    WideVec3 normal = wide::make_unit(corners.blend_vector(kFrame + 6, at));
    normal = wide::select(normal == WideVec3{zero, zero, zero},
                          wide::make_unit(wide::cross(along_u.base, along_v.base)), normal);
    const auto is_seam = [&](int edge) HWY_ATTR { return wide::is_set(lanes.is_seam[edge]); };
    const WideVec2 ends_u = wide::find_difference_ends(at.x, half_cell, is_seam(3), is_seam(1));
    const WideVec2 ends_v = wide::find_difference_ends(at.y, half_cell, is_seam(0), is_seam(2));
    const auto fetch = [&](const WideVec2& place)
                           HWY_ATTR { return fetch_decoded(from.map, from.normals, corners, place); };
    along_u.displacement = (fetch({ends_u.y, at.y}) - fetch({ends_u.x, at.y})) / (ends_u.y - ends_u.x);
    along_v.displacement = (fetch({at.x, ends_v.y}) - fetch({at.x, ends_v.x})) / (ends_v.y - ends_v.x);
    if (!from.map.is_tangent)
        return wide::make_displaced_normal(wide::displace_derivative(along_u, normal),
                                           wide::displace_derivative(along_v, normal), normal);
    const wide::Basis frame{corners.blend_vector(kFrame, at), corners.blend_vector(kFrame + 3, at),
                            corners.blend_vector(kFrame + 6, at)};
    const WideVec3 d = fetch(at);
    return wide::make_displaced_normal(wide::displace_derivative_through(along_u, frame, d, normal),
                                       wide::displace_derivative_through(along_v, frame, d, normal), normal);
}

/// Points of a batch from `first` on, with the surface's own shading normals, object space. Members of
/// SurfacePoint before position_error are written four floats at a time.
inline void store_points(const cpu::PointBatch& batch, size_t first, size_t count, const HitLanes& lanes,
                         const CellPointLanes& cell, const WideVec3& smooth, const WideVec2& uv) {
    static_assert(offsetof(cpu::SurfacePoint, position_error) == 48);
    const AffineLanes inverse(lanes.object_from_origin);
    const WideVec3 shading_normal = wide::orient_shading_normal(
        inverse.rows[0] * smooth.x + inverse.rows[1] * smooth.y + inverse.rows[2] * smooth.z,
        cell.triangle.normal);
    const WideVec3 &p = cell.triangle.position, &g = cell.triangle.normal, &s = shading_normal;
    LaneQuads quads[3];
    quads[0].set(p.x, p.y, p.z, g.x), quads[1].set(g.y, g.z, s.x, s.y);
    quads[2].set(s.z, uv.x, uv.y, cell.triangle.area_per_uv);
    alignas(64) float position_errors[16];
    cell.position_error.store(position_errors);
    for (size_t lane = 0; lane < count; ++lane) {
        const uint32_t k = batch.order[first + lane];
        cpu::SurfacePoint& point = batch.points[k];
        for (size_t q = 0; q < 3; ++q)
            std::memcpy(reinterpret_cast<char*>(&point) + 16 * q, quads[q].lane[lane], 16);
        point.position_error = position_errors[lane];
        point.instance = batch.hits[k].instance, point.patch = batch.hits[k].patch;
    }
}

HWY_NOINLINE inline void make_points(const cpu::PointBatch& batch, size_t first, size_t count) {
    HitLanes lanes;
    if (count < 16) lanes.clear();
    for (LaneMask& mask : lanes.is_foreign) mask = 0;
    for (size_t lane = 0; lane < count; ++lane)
        load_hit(batch, batch.hits[batch.order[first + lane]], lane, lanes);

    const cpu::TraceHit& any = batch.hits[batch.order[first]];
    const Surface& surface = batch.scene.surfaces[batch.scene.instances[any.instance].surface];
    const TileIndex tile = surface.tile(surface.quads[any.patch].vertex[0]);
    const uint32_t mips = surface.packed_mips(any.patch);
    const MapLanes from{surface.map,
                        {tile, scalar::packed_mip(mips, scalar::kMipInside)},
                        {tile, scalar::choose_normal_mip(mips)}};
    const CornerLanes corners(lanes, surface);
    const Lanes16 side = Lanes16::load(lanes.side);
    const CellPointLanes cell = make_cell_point(
        lanes, evaluate_cell_vertex(lanes, from, corners, 0), evaluate_cell_vertex(lanes, from, corners, 1),
        evaluate_cell_vertex(lanes, from, corners, 2), Lanes16(0.5f) / (side * side));
    const WideVec2 at{Lanes16::load(lanes.u), Lanes16::load(lanes.v)};
    store_points(batch, first, count, lanes, cell, compute_shading_normals(lanes, from, corners),
                 {corners.blend(kUv, at), corners.blend(kUv + 1, at)});
}

/// All points of a batch.
template <void (*kMakePoints)(const cpu::PointBatch&, size_t first, size_t count)>
void make_batch(const cpu::PointBatch& batch) {
    for (size_t first = 0; first < batch.count; first += 16)
        kMakePoints(batch, first, HWY_MIN(size_t(16), batch.count - first));
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
