// Sixteen vertices of paths at once: what they reflect of the light that was drawn, and the rays that go on.
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
HWY_INLINE Vec2 read_ggx_table(const Uint& index) {
    const Uint entry = min(index, Uint(scalar::kGgxEntryCount - 1));
    return {gather(scalar::kGgxScale, entry), gather(scalar::kGgxBias, entry)};
}

using scalar::kGgxAverages;
#define RELIEF_LANES
// clang-format off
#include "formulas/ggx_albedo.h"
#include "formulas/bsdf.h"
// clang-format on
#undef RELIEF_LANES

/// The part of sixteen SurfacePoints that reflection needs.
struct PointLanes {
    Vec3 position, geometric_normal, shading_normal;
    Float position_error;

    HWY_INLINE PointLanes(const cpu::SurfacePoint* points, size_t count) {
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

/// Directions that sixteen rays came from.
HWY_INLINE Vec3 load_viewers(const cpu::TraceRay* rays, size_t count) {
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

HWY_INLINE Vec3 load_vectors(const LaneVectors& v) {
    return {Float::load(v[0]), Float::load(v[1]), Float::load(v[2])};
}
HWY_INLINE void store_vectors(const Vec3& v, LaneVectors& target) {
    v.x.store(target[0]), v.y.store(target[1]), v.z.store(target[2]);
}

HWY_INLINE Bool is_black(const Vec3& v) {
    const Float zero(0.0f);
    return v.x == zero && v.y == zero && v.z == zero;
}

struct Scattering {
    Basis basis;   ///< about the bent shading normal
    Vec3 wo_local; ///< towards the viewer, in it
    Bsdf bsdf;
};

HWY_INLINE void reflect_light(const PointLanes& point, const Scattering& scattering, cpu::VertexLanes& v) {
    const Vec3 direction = load_vectors(v.light_direction);
    const BsdfValue toward =
        evaluate_bsdf(scattering.bsdf, scattering.wo_local, to_local(scattering.basis, direction));
    const Float zero(0.0f);
    const Bool needs_shadow_ray = Float::load(v.light_pdf) > zero &&
                                  dot(direction, point.geometric_normal) > zero && !is_black(toward.value);
    v.needs_shadow_ray = to_mask(needs_shadow_ray);
    store_vectors(toward.value, v.light_reflected), toward.pdf.store(v.light_bsdf_pdf);
    store_vectors(offset_origin(point.position, point.geometric_normal, point.position_error, direction),
                  v.shadow_origin);
}

HWY_INLINE void reflect_path(const PointLanes& point, const Scattering& scattering, const Float& u_lobe,
                             const Vec2& u, cpu::VertexLanes& v) {
    const BsdfSample drawn = sample_bsdf(scattering.bsdf, scattering.wo_local, u_lobe, u);
    const Vec3 direction = make_unit(from_local(scattering.basis, drawn.direction));
    v.has_bounce = to_mask(dot(point.geometric_normal, direction) > Float(0.0f) && !is_black(drawn.weight));
    store_vectors(direction, v.bounce_direction), store_vectors(drawn.weight, v.bounce_weight);
    drawn.pdf.store(v.bounce_pdf);
    store_vectors(offset_origin(point.position, point.geometric_normal, point.position_error, direction),
                  v.bounce_origin);
}

/// Lanes beyond the batch run along with numbers of no meaning; their masks are clear.
inline void reflect(const cpu::VertexBatch& batch, cpu::VertexLanes& v) {
    const size_t count = batch.count;
    PointLanes point(batch.points, count);
    const Vec3 wo = load_viewers(batch.rays, count);
    const Bool is_behind = dot(point.geometric_normal, wo) < Float(0.0f);
    point.geometric_normal = select(is_behind, -point.geometric_normal, point.geometric_normal);
    point.shading_normal = select(is_behind, -point.shading_normal, point.shading_normal);
    store_vectors(point.geometric_normal, v.geometric_normal);
    store_vectors(point.shading_normal, v.shading_normal);

    Scattering scattering;
    scattering.basis = make_basis(bend_normal(point.shading_normal, point.geometric_normal, wo));
    scattering.wo_local = lift_viewer(to_local(scattering.basis, wo));
    scattering.bsdf = make_bsdf(
        {load_vectors(v.base_color), Float::load(v.roughness), Float::load(v.metallic), Float::load(v.ior)},
        scattering.wo_local.z);
    const LaneMask lanes = first_lanes(count);
    reflect_light(point, scattering, v);
    v.has_bounce = 0;
    if (batch.pick_pairs)
        reflect_path(point, scattering, load_pairs(batch.pick_pairs, count).y,
                     load_pairs(batch.bsdf_pairs, count), v);
    v.needs_shadow_ray &= lanes, v.has_bounce &= lanes;
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
