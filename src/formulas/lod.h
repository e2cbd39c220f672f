// Paper 1's rule for levels: by the width of a ray where it meets a patch (Harada 2015, section 1.4.2). The
// paper takes the distance at which the ray enters the patch's box; here it is where the ray passes the
// patch's middle, which does not depend on the boxes of any tree.
#ifndef RELIEF_LOD_H
#define RELIEF_LOD_H
#include "formulas/begin.h"

/// Where a ray passes the middle of a patch: its distance in world units, not before its start.
FN float find_passing_distance(Vec3 origin, Vec3 direction, float t_min, Vec3 middle) {
    float size = length(direction);
    return max(dot(middle - origin, direction) / size, t_min * size);
}

/// Level at which the longest edge of a patch, world space, has cells of the ray's width: at `distance` the
/// ray is distance * pixel_angle wide. At most `finest`.
FN uint choose_ray_level(float longest_edge, float distance, float pixel_angle, uint finest) {
    float width = pixel_angle * max(distance, 1e-20f);
    uint bits = floatBitsToUint(max(longest_edge / width, 1.0f));
    uint wanted = (bits >> 23u) - 127u; // the logarithm to base 2, rounded up
    if ((bits & 0x7fffffu) != 0u) wanted += 1u;
    return min(wanted, finest);
}

#include "formulas/end.h"
#endif
