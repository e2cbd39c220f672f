// Sixteen vertices of paths at once: what they reflect of the light that was drawn, and the rays that go on.
#pragma once

#include "cpu/shading/diffuse_shares-inl.h"
#include "cpu/shading/glass-inl.h"
#include "cpu/shading/layers-inl.h"
#include "cpu/shading/vertex_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

struct Scattering {
    Basis basis;   ///< about the bent shading normal
    Vec3 wo_local; ///< towards the viewer, in it
    Bsdf bsdf;
};

RELIEF_INLINE void reflect_light(const PointLanes& point, const Scattering& scattering, cpu::VertexLanes& v) {
    const Vec3 direction = load_vectors(v.light_direction);
    store_light(point, direction,
                evaluate_bsdf(scattering.bsdf, scattering.wo_local, to_local(scattering.basis, direction)),
                v);
}

RELIEF_INLINE void reflect_path(const PointLanes& point, const Scattering& scattering, const Float& u_lobe,
                                const Vec2& u, cpu::VertexLanes& v) {
    const BsdfSample drawn = sample_bsdf(scattering.bsdf, scattering.wo_local, u_lobe, u);
    store_path(point, make_unit(from_local(scattering.basis, drawn.direction)), drawn.weight, drawn.pdf, v);
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
    if (v.has_layers & lanes) reflect_layers(batch, point, scattering.basis, scattering.wo_local, v);
    if (v.has_glass & lanes) reflect_glass(batch, point, scattering.basis, scattering.wo_local, is_behind, v);
    if (batch.wants_diffuse_shares) find_diffuse_shares(batch, v);
    v.needs_shadow_ray &= lanes, v.has_bounce &= lanes;
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
