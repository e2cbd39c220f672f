#include "cpu/shading/terminator.h"

#include <array>

#include "cpu/shading/surface_points.h"
#include "formulas/cell_place.h"
#include "formulas/mips.h"
#include "formulas/terminator.h"

namespace relief::cpu {

namespace {

/// Detail finer than the cells, which normals alone have, says nothing of how far away the surface is.
bool may_lift(const PreparedScene& scene, const Surface& surface, uint32_t patch) {
    if (surface.frames.empty()) return false;
    return !surface.has_displacement ||
           (scene.terminators == Terminators::all && !scalar::has_detail(surface.packed_mips(patch)));
}

Vec3f find_normal(const Surface& surface, const PatchSamples* samples, const TraceHit& hit, const Vec2f& at) {
    const int level = unpack_levels(hit.levels).patch;
    return samples ? compute_shading_normal(surface, *samples, hit.patch, level, at.x, at.y)
                   : compute_shading_normal(surface, hit.patch, level, at.x, at.y);
}

/// At the corners of find_corners(), object space.
std::array<Vec3f, 3> find_corner_normals(const Surface& surface, const PatchSamples* samples,
                                         const TraceHit& hit) {
    if (!samples) {
        const Quad quad = surface.quads[hit.patch];
        const auto normal = [&](size_t k) { return unpack_normal(surface.frames[quad.vertex[k]]); };
        return {normal(0), normal(hit.is_upper ? 2 : 1), normal(hit.is_upper ? 3 : 2)};
    }
    const float cell = 1.0f / float(1u << unpack_levels(hit.levels).patch);
    const auto normal = [&](uint32_t i, uint32_t j) {
        return find_normal(surface, samples, hit, {float(hit.i + i) * cell, float(hit.j + j) * cell});
    };
    return {normal(0, 0), hit.is_upper ? normal(1, 1) : normal(1, 0),
            hit.is_upper ? normal(0, 1) : normal(1, 1)};
}

} // namespace

float find_light_lift(const PreparedScene& scene, const TraceHit& hit, const SurfacePoint& point,
                      const FallingLight& light, PatchSamplesCache& patches) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    const Vec3f& lit = light.geometric_normal;
    if (dot(light.direction, lit) > 0 || !may_lift(scene, surface, hit.patch)) return 0;
    const auto find_samples = [&] {
        return surface.has_displacement ? &patches.get(surface, hit.patch) : nullptr;
    };
    const Vec3f smooth =
        scene.has_normal_maps
            ? scalar::orient_shading_normal(
                  transform_normal(instance.object_space.from_origin,
                                   find_normal(surface, find_samples(), hit, {hit.u, hit.v})),
                  lit)
            : point.shading_normal * (dot(point.geometric_normal, lit) < 0 ? -1.0f : 1.0f);
    if (!scalar::is_lost_light(light.direction, lit, smooth)) return 0;

    const PatchSamples* samples = find_samples();
    const auto [a, b, c] = find_corners(scene, hit, samples);
    const auto [na, nb, nc] = find_corner_normals(surface, samples, hit);
    const scalar::CornerWeights weights = scalar::weigh_corners(
        {hit.u, hit.v, hit.i, hit.j, hit.is_upper != 0}, float(1u << unpack_levels(hit.levels).patch));
    const Vec3f at = scalar::blend_corners(a, b, c, weights);
    const auto find_height = [&](const Vec3f& corner, const Vec3f& normal) {
        return scalar::find_tangent_height(
            transform_vector(instance.world_from_object, corner - at),
            normalize(transform_normal(instance.object_space.from_origin, normal)), lit);
    };
    return scalar::blend_tangent_heights({find_height(a, na), find_height(b, nb), find_height(c, nc)},
                                         weights);
}

} // namespace relief::cpu
