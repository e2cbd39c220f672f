// Surface points of sixteen hits on plain polygons: bit-identical to Tracer::make_surface_point.
#pragma once

#include "cpu/shading/surface_points-inl.h"
#include "formulas/frame.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// A corner of sixteen polygons, lane by lane.
struct PolygonCorner {
    LaneQuads place;  ///< position, u
    LaneQuads normal; ///< v, octahedral coordinates of the normal

    RELIEF_INLINE void load(const Surface& surface, uint32_t vertex, size_t lane) {
        const Vec3f& p = surface.position(vertex);
        const Vec2f uv = surface.uvs.empty() ? Vec2f{} : surface.uvs[vertex];
        const Vec2f folded =
            surface.frames.empty() ? Vec2f{} : scalar::unpack_octahedron(surface.frames[vertex].normal);
        const float first[4] = {p.x, p.y, p.z, uv.x}, second[4] = {uv.y, folded.x, folded.y, 0};
        std::memcpy(place.lane[lane], first, 16), std::memcpy(normal.lane[lane], second, 16);
    }
};

/// A corner of sixteen polygons.
struct WideCorner {
    WideVec3 position, normal;
    WideVec2 uv;

    RELIEF_INLINE explicit WideCorner(const PolygonCorner& corner) {
        Lanes16 x, y, unused;
        corner.place.transpose(position.x, position.y, position.z, uv.x);
        corner.normal.transpose(uv.y, x, y, unused);
        normal = wide::unfold_octahedron(x, y);
    }
};

/// compute_shading_normal (surface/patch/shading_normal.cpp) of each lane.
RELIEF_INLINE WideVec3 blend_polygon_normals(const Surface& surface, const WideCorner (&c)[4],
                                             const wide::Bool& is_triangle, const WideVec2& at) {
    const Lanes16 zero(0.0f);
    if (surface.frames.empty()) return {zero, zero, zero};
    // The triangle that the place is in, whatever the hit says.
    const wide::Bool is_upper = wide::operator&&(wide::operator>(at.y, at.x), wide::operator!(is_triangle));
    const WideVec3 facet = wide::cross(wide::select(is_upper, c[2].position, c[1].position) - c[0].position,
                                       wide::select(is_upper, c[3].position, c[2].position) - c[0].position);
    const WideVec3 blended =
        wide::select(is_triangle, wide::interpolate_triangle(c[0].normal, c[1].normal, c[2].normal, at),
                     wide::interpolate_quad(c[0].normal, c[1].normal, c[2].normal, c[3].normal, at));
    return wide::make_plain_normal(blended, facet);
}

HWY_NOINLINE inline void make_polygon_points(const cpu::PointBatch& batch, size_t first, size_t count) {
    HitLanes lanes;
    PolygonCorner corners[4];
    alignas(64) float is_triangle_lane[16] = {};
    if (count < 16) lanes.clear(), std::memset(&corners, 0, sizeof corners);
    for (size_t lane = 0; lane < count; ++lane) {
        const cpu::TraceHit& hit = batch.hits[batch.order[first + lane]];
        const Instance& instance = batch.scene.instances[hit.instance];
        const Surface& surface = batch.scene.surfaces[instance.surface];
        const Quad quad = surface.quads[hit.patch];
        load_place(instance, hit, unpack_levels(hit.levels), lane, lanes);
        for (size_t k = 0; k < 4; ++k) corners[k].load(surface, quad.vertex[k], lane);
        is_triangle_lane[lane] = quad.is_triangle() ? 1.0f : 0.0f;
    }
    const WideCorner c[4] = {WideCorner(corners[0]), WideCorner(corners[1]), WideCorner(corners[2]),
                             WideCorner(corners[3])};
    const wide::Bool is_triangle = wide::is_set(is_triangle_lane), is_upper = wide::is_set(lanes.is_upper);
    const WideVec2 at{Lanes16::load(lanes.u), Lanes16::load(lanes.v)};
    const Lanes16 side = Lanes16::load(lanes.side);
    const CellPointLanes cell =
        make_cell_point(lanes, c[0].position, wide::select(is_upper, c[2].position, c[1].position),
                        wide::select(is_upper, c[3].position, c[2].position),
                        wide::select(is_triangle, Lanes16(1.0f), Lanes16(0.5f) / (side * side)));
    const cpu::TraceHit& any = batch.hits[batch.order[first]];
    const Surface& surface = batch.scene.surfaces[batch.scene.instances[any.instance].surface];
    store_points(batch, first, count, lanes, cell, blend_polygon_normals(surface, c, is_triangle, at),
                 surface.has_bilinear_uvs ? wide::blend_patch_uv(c[0].uv, c[1].uv, c[2].uv, c[3].uv, at)
                                          : wide::blend_polygon_uv(c[0].uv, c[1].uv, c[2].uv, c[3].uv, at));
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
