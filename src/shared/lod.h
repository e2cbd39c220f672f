// Paper 1's rule for levels: by the width of a ray where it meets a patch (Harada 2015, section 1.4.2).
#ifndef RELIEF_LOD_H
#ifndef __cplusplus
#define RELIEF_LOD_H
#endif

/// Level at which the longest edge of a patch, world space, has cells of the ray's width: at `distance` the
/// ray is distance * pixel_angle wide. At most `finest`.
FN uint choose_ray_level(float longest_edge, float distance, float pixel_angle, uint finest) {
    float width = pixel_angle * max(distance, 1e-20f);
    float wanted = ceil(log2(max(longest_edge / width, 1.0f)));
    return uint(min(wanted, float(finest)));
}

#endif
