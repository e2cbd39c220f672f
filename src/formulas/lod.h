// Level selection by ray width at a patch (Harada 2015, section 1.4.2). The paper uses the distance at which
// the ray enters the patch's box; here it is the ray's closest point to the patch's centre, which does not
// depend on the boxes of any tree.
#ifndef RELIEF_LOD_H
#define RELIEF_LOD_H
#include "formulas/begin.h"

/// Distance, in world units and at least that of the ray's start, at which a ray passes the centre of a
/// patch.
FN float find_passing_distance(Vec3 origin, Vec3 direction, float t_min, Vec3 middle) {
    float size = length(direction);
    return max(dot(middle - origin, direction) / size, t_min * size);
}

/// Level at which cells along the longest edge of a patch, world space, have the ray's width, distance *
/// pixel_angle. At most `finest`.
FN uint choose_ray_level(float longest_edge, float distance, float pixel_angle, uint finest) {
    float width = pixel_angle * max(distance, 1e-20f);
    uint bits = floatBitsToUint(max(longest_edge / width, 1.0f));
    uint wanted = (bits >> 23u) - 127u; // log2, rounded up
    if ((bits & 0x7fffffu) != 0u) wanted += 1u;
    return min(wanted, finest);
}

#include "formulas/end.h"
#endif
