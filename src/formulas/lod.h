// Level selection by ray width at a patch (Harada 2015, section 1.4.2), at the ray's closest point to the
// patch's centre: unlike the paper's entry into a box, that does not depend on any tree.
#ifndef RELIEF_LOD_H
#define RELIEF_LOD_H
#include "formulas/begin.h"

/// Distance, world units, at which a ray passes a patch's centre; at least that of its start.
FN float find_passing_distance(const Vec3 origin, const Vec3 direction, const float t_min,
                               const Vec3 middle) {
    float size = length(direction);
    return max(dot(middle - origin, direction) / size, t_min * size);
}

/// Level at which cells along a patch's longest edge have the ray's width, distance * pixel_angle.
FN uint choose_ray_level(const float longest_edge, const float distance, const float pixel_angle,
                         const uint finest) {
    float width = pixel_angle * max(distance, 1e-20f);
    uint bits = floatBitsToUint(max(longest_edge / width, 1.0f));
    uint wanted = (bits >> 23u) - 127u; // log2, rounded up
    if ((bits & 0x7fffffu) != 0u) wanted += 1u;
    return min(wanted, finest);
}

#include "formulas/end.h"
#endif
