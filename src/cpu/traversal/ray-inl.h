// One ray in the space of one object.
#pragma once

#include <cmath>

#include "cpu/traversal/kernels.h"
#include "formulas/lanes-inl.h"
#include "formulas/object_ray.h"
#include "math/affine.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

enum class Query { closest, any };

using scalar::kBoxSlack;
using scalar::kLeastSpeed;

struct RayState {
    float origin[3], reciprocal[3];
    float near_origin[3], far_origin[3]; ///< what the planes of boxes are measured from, in the order met
    int near_plane[3], far_plane[3]; ///< rows of a node's bounds that the ray meets first and last: k, 3 + k
    int axis[3];                     ///< two minor axes and the major one
    float shear[3];                  ///< of the minor axes; 1 / direction along the major one
    float t_min, t_max;
    uint32_t instance = kNoIndex;
    uint32_t padding; ///< to whole registers of four
    cpu::TraceHit hit;
};

/// Prepares a ray for an object; t keeps its meaning because the direction is not normalised.
HWY_INLINE void enter_object(const cpu::TraceRay& world, const Affine& object_from_world, RayState& ray) {
    const Vec3f o = transform_point(object_from_world, world.origin);
    const Vec3f d = transform_vector(object_from_world, world.direction);
    const float direction[3] = {d.x, d.y, d.z};
    ray.origin[0] = o.x, ray.origin[1] = o.y, ray.origin[2] = o.z;
    for (int k = 0; k < 3; ++k) {
        // Along an axis that the ray does not move on, 1 / 0 would make 0 * infinity on a box's face. A
        // finite factor and an origin moved outward by more than rounding let it touch the box alone.
        const bool is_still = std::fabs(direction[k]) < kLeastSpeed;
        const float margin = is_still ? 1e-6f * (std::fabs(ray.origin[k]) + 1e-24f) : 0.0f;
        const float lower_origin = ray.origin[k] + margin, upper_origin = ray.origin[k] - margin;
        ray.reciprocal[k] = 1.0f / (is_still ? kLeastSpeed : direction[k]);
        const bool is_negative = ray.reciprocal[k] < 0;
        ray.near_plane[k] = is_negative ? 3 + k : k;
        ray.far_plane[k] = is_negative ? k : 3 + k;
        ray.near_origin[k] = is_negative ? upper_origin : lower_origin;
        ray.far_origin[k] = is_negative ? lower_origin : upper_origin;
    }
    const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
    // Choices of values and a table: a branch on the axis would be unpredictable.
    static constexpr int kMinorAxes[3][2] = {{1, 2}, {2, 0}, {0, 1}};
    const int wider = ax > ay ? 0 : 1;
    const int major = (ax > ay ? ax : ay) > az ? wider : 2;
    ray.axis[2] = major, ray.axis[0] = kMinorAxes[major][0], ray.axis[1] = kMinorAxes[major][1];
    ray.shear[2] = 1.0f / direction[major];
    ray.shear[0] = direction[ray.axis[0]] * ray.shear[2];
    ray.shear[1] = direction[ray.axis[1]] * ray.shear[2];
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
