// The conservative slab test: a ray that meets anything inside a box never misses the box.
#pragma once

#include <cmath>
#include <limits>

#include "lab/walks/walks.h"
#include "math/box.h"

namespace relief {

/// What the slab test needs of a ray, made once. The interval is passed with each test, since hits shorten
/// it.
class SlabRay {
  public:
    /// 1 + 2 gamma(3).
    static constexpr float kWiden = 1 + 2 * (3 * 0x1p-24f / (1 - 3 * 0x1p-24f));

    explicit SlabRay(const BoxRay& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            origin_[axis] = get_component(ray.origin, axis);
            const float d = get_component(ray.direction, axis);
            // Slower than this, 1 / d is no float: the ray counts as parallel to the slab.
            reciprocal_[axis] = std::copysign(std::fabs(d) < kSlowest ? kInfinity : 1 / std::fabs(d), d);
        }
    }

    /// Entry into the box, at least t_min; infinity: the box and [t_min, t_max] of the ray have nothing in
    /// common. Each distance is off by at most gamma(3) = 3 * 2^-24, near and far opposite ways, hence the
    /// widening of the far end (Ize 2013, Robust BVH Ray Traversal). A parallel ray on the face of a slab
    /// makes 0 * infinity = NaN, which loses every comparison below: the face belongs to the box.
    float compute_entry(const Box& box, float t_min, float t_max) const {
        const float lower[3] = {box.lower.x, box.lower.y, box.lower.z};
        const float upper[3] = {box.upper.x, box.upper.y, box.upper.z};
        float near = t_min, far = t_max;
        for (int axis = 0; axis < 3; ++axis) {
            const bool is_backward = std::signbit(reciprocal_[axis]);
            const float first = is_backward ? upper[axis] : lower[axis];
            const float last = is_backward ? lower[axis] : upper[axis];
            const float enter = (first - origin_[axis]) * reciprocal_[axis];
            const float leave = (last - origin_[axis]) * reciprocal_[axis];
            near = enter > near ? enter : near;
            far = leave < far ? leave : far;
        }
        return near <= far * kWiden ? near : kInfinity;
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr float kSlowest = 0x1p-126f;

    float origin_[3];
    float reciprocal_[3];
};

} // namespace relief
