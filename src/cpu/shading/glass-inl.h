// Glass at sixteen vertices: formulas/glass_bsdf.h in the lanes that are glass.
#pragma once

#include "cpu/shading/layers-inl.h"
#include "cpu/shading/vertex_lanes-inl.h"
#include "formulas/glass.h"
#include "formulas/glass_parameters.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

#define RELIEF_LANES
// clang-format off
#include "formulas/glass_parameters.h"
#include "formulas/glass.h"
#include "formulas/glass_bsdf.h"
// clang-format on
#undef RELIEF_LANES

RELIEF_INLINE GlassParameters gather_glass(const scalar::GlassParameters* records, const Uint& index) {
    static_assert(sizeof(GlassParameters) == 16 * sizeof(scalar::GlassParameters));
    RecordReader from(records, index);
    GlassParameters g;
    g.weight = from.read(), g.ior = from.read();
    g.specular_color = from.read_vector(), g.tint = from.read_vector(), g.depth = from.read_vector();
    g.anisotropy = from.read(), g.kind = from.read();
    return g;
}

/// What was found for lanes without glass stays.
struct GlassLanes {
    Basis basis;
    Vec3 wo_local;
    GlassBsdf bsdf;
    Bool is_glass;
};

/// Whether a direction is on one side of the surface and of the shading normal.
RELIEF_INLINE Bool is_on_one_side(const PointLanes& point, const Vec3& direction, const Vec3& local) {
    const Float height = dot(direction, point.geometric_normal), zero(0.0f);
    return (height > zero && local.z > zero) || (height < zero && local.z < zero);
}

/// `mask` in the lanes of glass, `others` in the others.
RELIEF_INLINE LaneMask join_masks(const GlassLanes& glass, const Bool& mask, LaneMask others) {
    const LaneMask lanes = to_mask(glass.is_glass);
    return (to_mask(mask) & lanes) | (others & ~lanes);
}

RELIEF_INLINE void reflect_light(const PointLanes& point, const GlassLanes& glass, cpu::VertexLanes& v) {
    const Vec3 direction = load_vectors(v.light_direction);
    const Vec3 wi = to_local(glass.basis, direction);
    const BsdfValue toward = evaluate_glass_bsdf(glass.bsdf, glass.wo_local, wi);
    const Bool is_lit = Float::load(v.light_pdf) > Float(0.0f) && !is_black(toward.value) &&
                        is_on_one_side(point, direction, wi);
    v.needs_shadow_ray = join_masks(glass, is_lit, v.needs_shadow_ray);
    store_vectors(select(glass.is_glass, toward.value, load_vectors(v.light_reflected)), v.light_reflected);
    select(glass.is_glass, toward.pdf, Float::load(v.light_bsdf_pdf)).store(v.light_bsdf_pdf);
}

RELIEF_INLINE void reflect_path(const PointLanes& point, const GlassLanes& glass, const Float& u_lobe,
                                const Vec2& u, cpu::VertexLanes& v) {
    const BsdfSample drawn = sample_glass_bsdf(glass.bsdf, glass.wo_local, u_lobe, u);
    const Vec3 direction = make_unit(from_local(glass.basis, drawn.direction));
    const Bool goes_on = !is_black(drawn.weight) && is_on_one_side(point, direction, drawn.direction);
    v.has_bounce = join_masks(glass, goes_on, v.has_bounce);
    const Vec3 origin =
        offset_origin(point.position, point.geometric_normal, point.position_error, direction);
    store_vectors(select(glass.is_glass, direction, load_vectors(v.bounce_direction)), v.bounce_direction);
    store_vectors(select(glass.is_glass, drawn.weight, load_vectors(v.bounce_weight)), v.bounce_weight);
    store_vectors(select(glass.is_glass, origin, load_vectors(v.bounce_origin)), v.bounce_origin);
    select(glass.is_glass, drawn.pdf, Float::load(v.bounce_pdf)).store(v.bounce_pdf);
}

/// Out of line: other vertices keep their registers. `is_behind`: the viewer is inside, if there is one.
HWY_NOINLINE void reflect_glass(const cpu::VertexBatch& batch, const PointLanes& point, const Basis& basis,
                                const Vec3& wo_local, const Bool& is_behind, cpu::VertexLanes& v) {
    const LaneMask lanes = v.has_glass & first_lanes(batch.count);
    GlassLanes glass{.basis = basis, .wo_local = wo_local};
    glass.bsdf = make_glass_bsdf(gather_glass(batch.glass, load_indices(v.glass, lanes)),
                                 Float::load(v.roughness), is_behind);
    glass.is_glass = from_mask(lanes);
    const Bool& has_tangent = glass.bsdf.facets.is_stretched;
    if (is_any(has_tangent)) turn_frame(batch, v, has_tangent, glass.basis, glass.wo_local);
    reflect_light(point, glass, v);
    if (batch.pick_pairs)
        reflect_path(point, glass, load_pairs(batch.pick_pairs, batch.count).y,
                     load_pairs(batch.bsdf_pairs, batch.count), v);
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
