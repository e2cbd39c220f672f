// Rays of callers may be anything. An invalid one hits nothing: walks count on
// numbers, and where all comparisons are false, an empty slot of a node is entered like any other.
#pragma once

#include "relief/types.h"

namespace relief {

/// False for a ray whose origin or direction is infinite or NaN, or whose interval is empty.
template <class Ray> bool can_hit(const Ray& ray) {
    const Vec3f sum = ray.origin + ray.direction;
    const float all = sum.x + sum.y + sum.z;
    return all - all == 0 && ray.t_min <= ray.t_max;
}

} // namespace relief
