// Light from below a triangle, but from above the smooth surface that its normals stand for: without it the
// shading ends in steps, triangle by triangle. docs/decisions/shading-terminator.md says why this is right.
#ifndef RELIEF_TERMINATOR_H
#define RELIEF_TERMINATOR_H
#include "formulas/displace.h"
#include "formulas/surface_point.h"

#include "formulas/begin.h"

/// Cosine between the normals above which a triangle is flat: a tenth of a degree, more than file formats and
/// packed normals round by, and less than can be seen.
const float kFlatCosine = 0.999998f;
/// Of a corner's normal to the triangle's: one that leans further says nothing of how the surface is curved.
const float kLeastCornerCosine = 0.5f;

/// Whether a triangle hides light that the smooth surface gets. Normals are unit vectors on the side that is
/// lit; `smooth_normal`: interpolated, before normal maps.
FN bool is_lost_light(const Vec3 direction, const Vec3 geometric_normal, const Vec3 smooth_normal) {
    return dot(direction, geometric_normal) <= 0.0f && dot(direction, smooth_normal) > 0.0f &&
           dot(geometric_normal, smooth_normal) < kFlatCosine;
}

/// Height above a point of a triangle, along its unit normal on the side that is lit, of the plane that
/// touches the smooth surface at a corner.
FN float find_tangent_height(const Vec3 to_corner, const Vec3 corner_normal, const Vec3 geometric_normal) {
    float cosine = dot(corner_normal, geometric_normal);
    return abs(cosine) < kLeastCornerCosine ? 0.0f : dot(to_corner, corner_normal) / cosine;
}

/// Height of the smooth surface above a point of a triangle: half of what the planes at its corners say, as a
/// parabola lies half way below its tangents; nothing where it lies below. `heights`: of find_tangent_height.
FN float blend_tangent_heights(const Vec3 heights, const CornerWeights weights) {
    return 0.5f * ((1.0f - weights.b - weights.c) * max(heights.x, 0.0f) + weights.b * max(heights.y, 0.0f) +
                   weights.c * max(heights.z, 0.0f));
}

/// The same above a point of a flat patch that is a part of a face. `heights`: of find_tangent_height at the
/// corners of the patch, `base_heights`: of the smooth surface above these corners; both in the order of
/// blend_quad.
FN float blend_base_heights(const float heights[4], const float base_heights[4], const Vec2 at) {
    float local = blend_quad(max(heights[0], 0.0f), max(heights[1], 0.0f), max(heights[2], 0.0f),
                             max(heights[3], 0.0f), at.x, at.y);
    float whole = blend_quad(base_heights[0], base_heights[1], base_heights[2], base_heights[3], at.x, at.y);
    return 0.5f * local + max(whole, 0.0f);
}

#include "formulas/end.h"
#endif
