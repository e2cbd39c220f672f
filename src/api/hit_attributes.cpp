#include "api/hit_attributes.h"

#include "base/parallel.h"
#include "cpu/shading/surface_points.h"
#include "math/affine.h"

namespace relief {

namespace {

constexpr size_t kGrain = 256;

/// Position derivatives of the micro-triangle, which is linear in (u, v); a cell spans 1 / side of u and v.
void compute_derivatives(const PreparedScene& scene, const cpu::TraceHit& hit, const PatchSamples* samples,
                         HitAttributes& result) {
    const Affine& world_from_object = scene.instances[hit.instance].world_from_object;
    const auto [a, b, c] = cpu::find_corners(scene, hit, samples);
    const float side = float(1u << unpack_levels(hit.levels).patch);
    const Vec3f along_u = hit.is_upper ? b - c : b - a, along_v = hit.is_upper ? c - a : c - b;
    result.dp_du = transform_vector(world_from_object, along_u) * side;
    result.dp_dv = transform_vector(world_from_object, along_v) * side;
}

HitAttributes compute_attributes(const PreparedScene& scene, uint32_t wanted, const RayHit& hit) {
    HitAttributes result;
    if (hit.object == kNoIndex) return result;
    const cpu::TraceHit place = cpu::locate_hit(scene, hit.object, hit.patch, hit.uv, 0);
    const std::optional<PatchSamples> samples = cpu::unpack_patch(scene, place);
    const PatchSamples* const patch = samples ? &*samples : nullptr;
    if (wanted & (kShadingNormal | kTextureUv)) {
        const cpu::SurfacePoint point = cpu::make_shading_point(scene, place, patch);
        if (wanted & kShadingNormal) result.shading_normal = point.shading_normal;
        if (wanted & kTextureUv) result.texture_uv = point.uv;
    }
    if (wanted & kDerivatives) compute_derivatives(scene, place, patch, result);
    return result;
}

} // namespace

void compute_hit_attributes(const PreparedScene& scene, uint32_t wanted, std::span<const RayHit> hits,
                            std::span<HitAttributes> attributes) {
    parallel_for("hit_attributes", hits.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) attributes[k] = compute_attributes(scene, wanted, hits[k]);
    });
}

} // namespace relief
