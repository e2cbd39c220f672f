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
const uint kBaseTerminators = 2u, kAllTerminators = 3u; ///< Terminators::bases and all

/// Detail finer than the cells, which normals alone have, says nothing of how far away the surface is.
bool may_lift_triangle(const HitData hit) {
    SurfaceData s = surfaces[instances[hit.instance].surface];
    if (s.first_frame == kNone) return false;
    return s.map == kNone || (kTerminators == kAllTerminators && !has_detail(load_mips(s, hit.patch_index)));
}

bool may_lift_base(const SurfaceData s) {
    return kTerminators >= kBaseTerminators && s.map != kNone && s.first_control == kNone && s.first_frame != kNone;
}

bool may_lift(const HitData hit) {
    return may_lift_triangle(hit) || may_lift_base(surfaces[instances[hit.instance].surface]);
}

/// Corner of the triangle that was hit, 0 to 2, among those of its cell: 00 10 11 01.
uint find_cell_corner(const HitData hit, const uint k) {
    return k + (cell_is_upper(hit.cell) != 0u && k > 0u ? 1u : 0u);
}

uvec2 find_corner_sample(const HitData hit, const uint around) {
    return uvec2(cell_column(hit.cell) + (around == 1u || around == 2u ? 1u : 0u),
                 cell_row(hit.cell) + (around >= 2u ? 1u : 0u));
}

/// Object space.
vec3 find_triangle_corner(const SurfaceData s, const HitData hit, const uint k) {
    uint around = find_cell_corner(hit, k);
    if (s.map == kNone) return load_position(s, load_quad(s, hit.patch_index)[around]);
    if (kTerminators != kAllTerminators) return vec3(0.0);
    uvec2 at = find_corner_sample(hit, around);
    return find_sample(s, hit.patch_index, hit.levels, at.x, at.y);
}

/// Of the smooth surface, object space: at the point for `turn` 0, then at the corners.
vec3 find_smooth_normal(const SurfaceData s, const HitData hit, const uint turn) {
    uvec4 quad = load_quad(s, hit.patch_index);
    vec2 at = vec2(hit.u, hit.v);
    uint around = find_cell_corner(hit, max(turn, 1u) - 1u);
    if (s.map == kNone) return turn == 0u ? compute_plain_normal(s, quad, at) : load_normal(s, quad[around]);
    if (kTerminators != kAllTerminators) return vec3(0.0);
    uint level = packed_patch_level(hit.levels);
    if (turn > 0u) at = vec2(find_corner_sample(hit, around)) * (1.0 / float(1u << level));
    return compute_displaced_normal(s, quad, hit.patch_index, level, at);
}

/// By the triangle that was hit and the normals at its corners.
float find_triangle_lift(const HitData hit, const vec3 geometric_normal, const vec3 direction) {
    if (dot(direction, geometric_normal) > 0.0 || !may_lift_triangle(hit)) return 0.0;
    SurfaceData s = surfaces[instances[hit.instance].surface];
    vec3 corner[3];
    for (uint k = 0u; k < 3u; ++k) corner[k] = find_triangle_corner(s, hit, k);
    CellPlace place = {hit.u, hit.v, cell_column(hit.cell), cell_row(hit.cell), cell_is_upper(hit.cell) != 0u};
    CornerWeights weights = weigh_corners(place, float(1u << packed_patch_level(hit.levels)));
    vec3 at = blend_corners(corner[0], corner[1], corner[2], weights);
    bool is_lost = true;
    vec3 heights = vec3(0.0);
    // One loop, so that the normal is inlined only once.
    for (uint turn = 0u; turn < 4u && is_lost; ++turn) {
        vec3 normal = transform_normal(instances[hit.instance].object_from_origin, find_smooth_normal(s, hit, turn));
        if (turn == 0u)
            is_lost = is_lost_light(direction, geometric_normal, orient_shading_normal(normal, geometric_normal));
        else
            heights[turn - 1u] = find_tangent_height(
                transform_vector(instances[hit.instance].world_from_object, corner[turn - 1u] - at), make_unit(normal),
                geometric_normal);
    }
    return is_lost ? blend_tangent_heights(heights, weights) : 0.0;
}

/// By the base of a displaced patch, whose smooth surface is as far away from it as that from the base.
float find_base_lift(const HitData hit, const vec3 geometric_normal, const vec3 direction) {
    SurfaceData s = surfaces[instances[hit.instance].surface];
    if (!may_lift_base(s)) return 0.0;
    vec2 at = vec2(hit.u, hit.v);
    uvec4 quad = load_quad(s, hit.patch_index);
    vec3 corner[4], corner_normal[4];
    float height[4], base_height[4];
    for (uint k = 0u; k < 4u; ++k) {
        corner[k] = load_position(s, quad[k]);
        corner_normal[k] = load_normal(s, quad[k]);
        base_height[k] = s.first_height == kNone
                             ? 0.0
                             : texelFetch(positions, int(s.first_height + load_dominant(s, quad[k]))).x;
    }
    vec3 normal = make_unit(cross(blend_difference(corner[0], corner[1], corner[3], corner[2], at.y),
                                  blend_difference(corner[0], corner[3], corner[1], corner[2], at.x)));
    AffineData object_from_origin = instances[hit.instance].object_from_origin;
    vec3 normal_world = transform_normal(object_from_origin, normal);
    float side = dot(normal_world, geometric_normal) < 0.0 ? -1.0 : 1.0;
    if (dot(direction, normal_world) * side > 0.0) return 0.0;
    vec3 lit = normal * side;
    vec3 smooth_normal =
        make_unit(interpolate_quad(corner_normal[0], corner_normal[1], corner_normal[2], corner_normal[3], at)) * side;
    if (!is_lost_light(transform_vector(object_from_origin, direction), lit, smooth_normal)) return 0.0;
    vec3 place = interpolate_quad(corner[0], corner[1], corner[2], corner[3], at);
    for (uint k = 0u; k < 4u; ++k) {
        height[k] = find_tangent_height(corner[k] - place, corner_normal[k], lit);
        base_height[k] *= side;
    }
    float lift = blend_base_heights(height, base_height, at);
    if (!(lift > 0.0)) return 0.0;
    return max(dot(transform_vector(instances[hit.instance].world_from_object, lit * lift), geometric_normal), 0.0);
}

/// How far above the point the smooth surface lies from which light of that direction is seen; 0: it comes
/// from above the triangle and from above the patch that is displaced, or from below what is smooth.
float find_light_lift(const HitData hit, const vec3 geometric_normal, const vec3 direction) {
    return max(find_triangle_lift(hit, geometric_normal, direction), find_base_lift(hit, geometric_normal, direction));
}

#else
const uint kTerminators = 0;
bool may_lift(const HitData hit) { return false; }
float find_light_lift(const HitData hit, const vec3 geometric_normal, const vec3 direction) { return 0.0; }
#endif

#endif
