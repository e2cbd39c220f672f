// What sixteen vertices scatter diffusely of the light that was drawn and of what comes along the next ray.
#pragma once

#include "cpu/shading/layers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

/// After all else was found, which it makes anew: out of line, it costs nothing where it is not asked for.
HWY_NOINLINE void find_diffuse_shares(const cpu::VertexBatch& batch, cpu::VertexLanes& v) {
    const Vec3 wo = load_viewers(batch.rays, batch.count);
    const Basis basis =
        make_basis(bend_normal(load_vectors(v.shading_normal), load_vectors(v.geometric_normal), wo));
    const Vec3 wo_local = lift_viewer(to_local(basis, wo));
    const Vec3 to_light = to_local(basis, load_vectors(v.light_direction));
    const Vec3 along_ray = to_local(basis, load_vectors(v.bounce_direction));
    const Bsdf bsdf = make_bsdf(
        {load_vectors(v.base_color), Float::load(v.roughness), Float::load(v.metallic), Float::load(v.ior)},
        wo_local.z);
    Vec3 light = evaluate_diffuse(bsdf, wo_local, to_light);
    Vec3 bounce = evaluate_diffuse(bsdf, wo_local, along_ray);
    if (v.has_layers & first_lanes(batch.count)) {
        const LayeredLanes layered = make_layered_lanes(batch, basis, wo_local, v);
        const auto evaluate = [&](const LaneVectors& direction) {
            return evaluate_layered_diffuse(layered.bsdf, layered.table, layered.wo_local,
                                            to_local(layered.basis, load_vectors(direction)));
        };
        light = select(layered.has_layers, evaluate(v.light_direction), light);
        bounce = select(layered.has_layers, evaluate(v.bounce_direction), bounce);
    }
    if (const LaneMask glass = v.has_glass & first_lanes(batch.count)) {
        const Bool is_glass = from_mask(glass);
        light = select(is_glass, make_grey(Float(0.0f)), light);
        bounce = select(is_glass, make_grey(Float(0.0f)), bounce);
    }
    store_vectors(find_shares(light, load_vectors(v.light_reflected)), v.light_diffuse);
    store_vectors(find_shares(bounce, load_vectors(v.bounce_weight) * Float::load(v.bounce_pdf)),
                  v.bounce_diffuse);
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
