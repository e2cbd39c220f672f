// Where shadow rays start that a coarse triangle hides from light which its smooth surface gets: as
// cpu/shading/terminator.cpp.
#ifndef RELIEF_TERMINATOR_GLSL
#define RELIEF_TERMINATOR_GLSL

#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/surface_point.glsl"
#include "vulkan/shaders/shading_normal.glsl"
#include "formulas/terminator.h"

// In the variant of the kernel for scenes that have them: others are much smaller without.
#ifdef HAS_TERMINATORS
layout(constant_id = kTerminatorsConstant) const uint kTerminators = 0;
const uint kAllTerminators = 2u; ///< those of displaced patches too

/// Detail finer than the cells, which normals alone have, says nothing of how far away the surface is.
bool may_lift(HitData hit) {
    SurfaceData s = surfaces[instances[hit.instance].surface];
    if (s.first_frame == kNone) return false;
    return s.map == kNone || (kTerminators == kAllTerminators && !has_detail(load_mips(s, hit.patch_index)));
}

/// Corners of a triangle with the smooth surface's normals there, and the normal at a point; object space.
struct SmoothTriangle {
    vec3 corner[3];
    vec3 normal[4];
};

SmoothTriangle find_smooth_triangle(SurfaceData s, HitData hit) {
    uvec4 quad = load_quad(s, hit.patch_index);
    uint level = packed_patch_level(hit.levels);
    SmoothTriangle result;
    // A loop, so that the evaluation is inlined only once; the last turn is the point itself.
    for (uint k = 0u; k < 4u; ++k) {
        uint around = k + (cell_is_upper(hit.cell) != 0u && k > 0u ? 1u : 0u);
        if (s.map == kNone) {
            if (k < 3u) result.corner[k] = load_position(s, quad[around]);
            result.normal[k] = k < 3u ? load_normal(s, quad[around])
                                      : compute_plain_normal(s, quad, vec2(hit.u, hit.v));
        } else if (kTerminators == kAllTerminators) {
            uint i = cell_column(hit.cell) + (around == 1u || around == 2u ? 1u : 0u);
            uint j = cell_row(hit.cell) + (around >= 2u ? 1u : 0u);
            if (k < 3u) result.corner[k] = find_sample(s, hit.patch_index, hit.levels, i, j);
            vec2 at = k < 3u ? vec2(i, j) * (1.0 / float(1u << level)) : vec2(hit.u, hit.v);
            result.normal[k] = compute_displaced_normal(s, quad, hit.patch_index, level, at);
        }
    }
    return result;
}

/// How far above the point the smooth surface lies from which light of that direction is seen; 0: it comes
/// from above the triangle, or from below both.
float find_light_lift(HitData hit, SurfacePointData point, vec3 direction) {
    if (dot(direction, point.geometric_normal) > 0.0 || !may_lift(hit)) return 0.0;
    InstanceData instance = instances[hit.instance];
    SmoothTriangle t = find_smooth_triangle(surfaces[instance.surface], hit);
    vec3 smooth_normal = orient_shading_normal(transform_normal(instance.object_from_origin, t.normal[3]),
                                               point.geometric_normal);
    if (!is_lost_light(direction, point.geometric_normal, smooth_normal)) return 0.0;
    CellPlace place = {hit.u, hit.v, cell_column(hit.cell), cell_row(hit.cell), cell_is_upper(hit.cell) != 0u};
    CornerWeights weights = weigh_corners(place, float(1u << packed_patch_level(hit.levels)));
    vec3 at = blend_corners(t.corner[0], t.corner[1], t.corner[2], weights);
    vec3 heights;
    for (uint k = 0u; k < 3u; ++k)
        heights[k] = find_tangent_height(transform_vector(instance.world_from_object, t.corner[k] - at),
                                         make_unit(transform_normal(instance.object_from_origin, t.normal[k])),
                                         point.geometric_normal);
    return blend_tangent_heights(heights, weights);
}

#else
const uint kTerminators = 0;
bool may_lift(HitData hit) { return false; }
float find_light_lift(HitData hit, SurfacePointData point, vec3 direction) { return 0.0; }
#endif

#endif
