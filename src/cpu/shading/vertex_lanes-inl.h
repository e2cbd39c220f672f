// Sixteen vertices of paths: their points and viewers as lanes, and what was found for them back into memory.
#pragma once

#include <cstring>

#include "cpu/shading/shading_kernels.h"
#include "cpu/traversal/lane_arrays-inl.h"
#include "formulas/ggx_table.h"
#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

/// Of any index: what lies beyond the table is not read.
RELIEF_INLINE Vec2 read_ggx_table(const Uint& index) {
    const Uint entry = min(index, Uint(scalar::kGgxEntryCount - 1));
    return {gather(scalar::kGgxScale, entry), gather(scalar::kGgxBias, entry)};
}

using scalar::kGgxAverages;
#define RELIEF_LANES
// clang-format off
#include "formulas/facets.h"
#include "formulas/ggx_albedo.h"
#include "formulas/bsdf.h"
// clang-format on
#undef RELIEF_LANES

/// The part of sixteen SurfacePoints that reflection needs.
struct PointLanes {
    Vec3 position, geometric_normal, shading_normal;
    Float position_error;

    RELIEF_INLINE PointLanes(const cpu::SurfacePoint* points, size_t count) {
        static_assert(offsetof(cpu::SurfacePoint, geometric_normal) == 12 &&
                      offsetof(cpu::SurfacePoint, shading_normal) == 24);
        LaneQuads quads[3];
        alignas(64) float errors[16];
        for (size_t lane = 0; lane < 16; ++lane) {
            const cpu::SurfacePoint& point = points[HWY_MIN(lane, count - 1)];
            for (size_t q = 0; q < 3; ++q)
                std::memcpy(quads[q].lane[lane], reinterpret_cast<const char*>(&point) + 16 * q, 16);
            errors[lane] = point.position_error;
        }
        Vec3 &p = position, &g = geometric_normal, &s = shading_normal;
        Float unused[3];
        quads[0].transpose(p.x, p.y, p.z, g.x), quads[1].transpose(g.y, g.z, s.x, s.y);
        quads[2].transpose(s.z, unused[0], unused[1], unused[2]);
        position_error = Float::load(errors);
    }
};

/// The other way round than to_mask().
RELIEF_INLINE Bool from_mask(LaneMask lanes) {
    alignas(64) float marks[16];
    for (size_t lane = 0; lane < 16; ++lane) marks[lane] = lanes >> lane & 1 ? 1 : 0;
    return is_set(marks);
}

/// Indices of records in the lanes that have one, 0 in the others.
RELIEF_INLINE Uint load_indices(const uint32_t (&indices)[16], LaneMask lanes) {
    alignas(64) uint32_t loaded[16];
    for (size_t lane = 0; lane < 16; ++lane) loaded[lane] = lanes >> lane & 1 ? indices[lane] : 0;
    return Uint::load(loaded);
}

/// Directions that sixteen rays came from.
RELIEF_INLINE Vec3 load_viewers(const cpu::TraceRay* rays, size_t count) {
    static_assert(offsetof(cpu::TraceRay, direction) == 16);
    LaneQuads quads;
    for (size_t lane = 0; lane < 16; ++lane)
        std::memcpy(quads.lane[lane], &rays[HWY_MIN(lane, count - 1)].direction, 16);
    Vec3 direction;
    Float t_max;
    quads.transpose(direction.x, direction.y, direction.z, t_max);
    return -direction;
}

using LaneVectors = float[3][16];

RELIEF_INLINE Vec3 load_vectors(const LaneVectors& v) {
    return {Float::load(v[0]), Float::load(v[1]), Float::load(v[2])};
}
RELIEF_INLINE void store_vectors(const Vec3& v, LaneVectors& target) {
    v.x.store(target[0]), v.y.store(target[1]), v.z.store(target[2]);
}

RELIEF_INLINE Bool is_black(const Vec3& v) {
    const Float zero(0.0f);
    return v.x == zero && v.y == zero && v.z == zero;
}

/// Turns a frame about its normal so that its first axis is the tangent, in the lanes that have one. Out of
/// line: it is rare.
HWY_NOINLINE void turn_frame(const cpu::VertexBatch& batch, const cpu::VertexLanes& v,
                             const Bool& has_tangent, Basis& basis, Vec3& wo_local) {
    const Basis turned = make_basis_along(basis.n, load_vectors(v.tangent));
    const Vec3 wo = lift_viewer(to_local(turned, load_viewers(batch.rays, batch.count)));
    basis.t = select(has_tangent, turned.t, basis.t), basis.b = select(has_tangent, turned.b, basis.b);
    wo_local = select(has_tangent, wo, wo_local);
}

RELIEF_INLINE void store_light(const PointLanes& point, const Vec3& direction, const BsdfValue& toward,
                               cpu::VertexLanes& v) {
    const Float zero(0.0f);
    const Float lift = Float::load(v.light_lift);
    const Bool is_lifted = lift > zero, is_above = dot(direction, point.geometric_normal) > zero;
    const Bool needs_shadow_ray =
        Float::load(v.light_pdf) > zero && (is_above || is_lifted) && !is_black(toward.value);
    v.needs_shadow_ray = to_mask(needs_shadow_ray);
    store_vectors(toward.value, v.light_reflected);
    // Paths find light from above the triangle too.
    select(is_above, toward.pdf, select(is_lifted, zero, toward.pdf)).store(v.light_bsdf_pdf);
    const Vec3 &p = point.position, &n = point.geometric_normal;
    store_vectors(select(is_lifted, p + n * (point.position_error + lift),
                         offset_origin(p, n, point.position_error, direction)),
                  v.shadow_origin);
}

RELIEF_INLINE void store_path(const PointLanes& point, const Vec3& direction, const Vec3& weight,
                              const Float& pdf, cpu::VertexLanes& v) {
    v.has_bounce = to_mask(dot(point.geometric_normal, direction) > Float(0.0f) && !is_black(weight));
    store_vectors(direction, v.bounce_direction), store_vectors(weight, v.bounce_weight);
    pdf.store(v.bounce_pdf);
    store_vectors(offset_origin(point.position, point.geometric_normal, point.position_error, direction),
                  v.bounce_origin);
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
