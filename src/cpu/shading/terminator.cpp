#include "cpu/shading/terminator.h"

#include <algorithm>
#include <array>

#include "cpu/shading/surface_points.h"
#include "formulas/cell_place.h"
#include "formulas/mips.h"
#include "formulas/shading_normal.h"
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

/// By the triangle that was hit and the normals at its corners.
float find_triangle_lift(const PreparedScene& scene, const TraceHit& hit, const SurfacePoint& point,
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

/// A flat patch that displacements start from, and the smooth surface that its normals stand for; object
/// space.
class FlatBase {
  public:
    FlatBase(const Surface& surface, const TraceHit& hit) : at_{hit.u, hit.v} {
        const Quad quad = surface.quads[hit.patch];
        for (size_t k = 0; k < 4; ++k) {
            corners_[k] = surface.position(quad.vertex[k]);
            normals_[k] = unpack_normal(surface.frames[quad.vertex[k]]);
            if (!surface.base_heights.empty())
                heights_[k] = surface.base_heights[surface.dominant(quad.vertex[k])];
        }
        const auto& [a, b, c, d] = corners_;
        normal_ = normalize(
            cross(scalar::blend_difference(a, b, d, c, at_.y), scalar::blend_difference(a, d, b, c, at_.x)));
    }

    const Vec3f& normal() const { return normal_; }

    /// How far the smooth surface that light of a direction comes to lies from the patch on the lit side,
    /// which is that of the normal times `side`; 0: the patch gets that light, or neither does.
    float find_lift(const Vec3f& direction, float side) const {
        const Vec3f lit = normal_ * side;
        const Vec3f smooth = normalize(blend(normals_)) * side;
        if (!scalar::is_lost_light(direction, lit, smooth)) return 0;
        const Vec3f place = blend(corners_);
        float heights[4], base_heights[4];
        for (size_t k = 0; k < 4; ++k) {
            heights[k] = scalar::find_tangent_height(corners_[k] - place, normals_[k], lit);
            base_heights[k] = heights_[k] * side;
        }
        return scalar::blend_base_heights(heights, base_heights, at_);
    }

  private:
    Vec3f blend(const std::array<Vec3f, 4>& values) const {
        return scalar::interpolate_quad(values[0], values[1], values[2], values[3], at_);
    }

    Vec2f at_;
    std::array<Vec3f, 4> corners_, normals_;
    std::array<float, 4> heights_{};
    Vec3f normal_;
};

/// By the base of a displaced patch, whose smooth surface is as far away from it as that from the base.
float find_base_lift(const PreparedScene& scene, const TraceHit& hit, const FallingLight& light) {
    const Instance& instance = scene.instances[hit.instance];
    const Surface& surface = scene.surfaces[instance.surface];
    if (scene.terminators < Terminators::bases || !surface.has_displacement || !surface.controls.empty() ||
        surface.frames.empty())
        return 0;
    const FlatBase base(surface, hit);
    const Affine& object_from_origin = instance.object_space.from_origin;
    const Vec3f normal = transform_normal(object_from_origin, base.normal());
    const float side = dot(normal, light.geometric_normal) < 0 ? -1.0f : 1.0f;
    if (dot(light.direction, normal) * side > 0) return 0;
    const float lift = base.find_lift(transform_vector(object_from_origin, light.direction), side);
    if (!(lift > 0)) return 0;
    const Vec3f way = transform_vector(instance.world_from_object, base.normal() * (side * lift));
    return std::max(dot(way, light.geometric_normal), 0.0f);
}

} // namespace

float find_light_lift(const PreparedScene& scene, const TraceHit& hit, const SurfacePoint& point,
                      const FallingLight& light, PatchSamplesCache& patches) {
    return std::max(find_triangle_lift(scene, hit, point, light, patches), find_base_lift(scene, hit, light));
}

} // namespace relief::cpu
