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
    float t_min, t_max;              ///< from `origin` on: what is sought in boxes
    uint32_t instance = kNoIndex;
    float shift; ///< the ray's own t at `origin`: not 0 where it was moved from far away to an object
    cpu::TraceHit hit;
    float own_t_min, own_t_max; ///< of a ray that was moved, in its own t

    /// Of hits, in the ray's own t.
    RELIEF_INLINE float hit_t_max() const { return shift == 0 ? t_max : own_t_max; }

    /// Nothing beyond `t` is sought any more. Own t of a moved ray are rounded: boxes are met somewhat
    /// further on.
    RELIEF_INLINE void shorten(float t) {
        if (shift == 0) {
            t_max = t;
            return;
        }
        own_t_max = t;
        t_max = (t - shift) + kShiftSlack * shift;
    }

    /// Both ends, from own t to those from `origin` on.
    void move_range() {
        own_t_min = t_min;
        t_min = (t_min - shift) - kShiftSlack * shift;
        shorten(t_max);
    }

    static constexpr float kShiftSlack = 2.4e-7f; ///< four roundings
};

/// Prepares a ray for a space; t keeps its meaning because the direction is not normalised. `start` is less
/// the origin of the space.
RELIEF_INLINE void enter_space(const scalar::LocalStart& start, const Vec3f& world_direction,
                               const Affine& space_from_origin, RayState& ray) {
    const Vec3f o = transform_point(space_from_origin, start.origin);
    const Vec3f d = transform_vector(space_from_origin, world_direction);
    ray.shift = start.shift;
    if (ray.shift != 0) ray.move_range();
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

RELIEF_INLINE void enter_world(const cpu::TraceRay& world, RayState& ray) {
    enter_space({world.origin, 0}, world.direction, Affine{}, ray);
}

RELIEF_INLINE bool is_far_away(const Vec3f& origin, const Instance& placed) {
    return scalar::is_far_away(origin, placed.world_from_object.translation, placed.reach);
}

/// Out of the way of all others.
HWY_NOINLINE inline scalar::LocalStart find_far_start(const cpu::TraceRay& world, const Instance& placed) {
    return scalar::find_local_start(world.origin, world.direction, placed.object_space.origin,
                                    placed.world_from_object.translation, placed.reach);
}

/// `ray` has its range and its hit.
RELIEF_INLINE void enter_object(const cpu::TraceRay& world, const Instance& placed, RayState& ray) {
    const scalar::LocalStart start = is_far_away(world.origin, placed)
                                         ? find_far_start(world, placed)
                                         : scalar::LocalStart{world.origin - placed.object_space.origin, 0};
    enter_space(start, world.direction, placed.object_space.from_origin, ray);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
