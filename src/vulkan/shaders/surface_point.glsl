// Surface points for shading.
#ifndef RELIEF_SURFACE_POINT_GLSL
#define RELIEF_SURFACE_POINT_GLSL

#include "vulkan/shaders/sample_evaluation.glsl"
#include "formulas/warp.h"
#include "formulas/surface_point.h"
#include "formulas/local_start.h"
#include "formulas/cell_place.h"
#include "formulas/shading_normal.h"
#include "vulkan/layout/device_rays.h"

/// Micro-triangle of a patch at packed levels, and the point on it.
struct CellPoint {
    TrianglePoint triangle;
    float position_error;
};

float bound_error(const uint instance, const vec3 a, const vec3 b, const vec3 c, const vec3 position) {
    AffineData world_from_object = instances[instance].world_from_object;
    float corner = max(max(largest_coordinate(a), largest_coordinate(b)), largest_coordinate(c));
    float row = max(max(sum_magnitudes(world_from_object.x), sum_magnitudes(world_from_object.y)),
                    sum_magnitudes(world_from_object.z));
    return bound_position_error(corner, row, largest_coordinate(world_from_object.t), largest_coordinate(position),
                                share_of_place(instances[instance].origin));
}

CellPoint evaluate_cell(const uint instance, const uint patch_index, const uint packed_levels, const CellPlace place) {
    SurfaceData s = surfaces[instances[instance].surface];
    uvec4 quad = load_quad(s, patch_index);
    vec3 corner[3];
    // Corners 00 10 11 of the lower triangle, 00 11 01 of the upper; a loop inlines the evaluation once.
    for (uint k = 0u; k < 3u; ++k) {
        uint around = k + (place.is_upper && k > 0u ? 1u : 0u);
        uint i = place.i + (around == 1u || around == 2u ? 1u : 0u);
        uint j = place.j + (around >= 2u ? 1u : 0u);
        corner[k] = s.map == kNone ? load_position(s, quad[around]) : find_sample(s, patch_index, packed_levels, i, j);
    }
    float side = float(1u << packed_patch_level(packed_levels));
    AffineData m = instances[instance].world_from_object;
    CornerWeights weights = weigh_corners(place, side);
    vec3 local = blend_corners(corner[0], corner[1], corner[2], weights);
    vec3 edge_b = transform_vector(m, corner[1] - corner[0]);
    vec3 edge_c = transform_vector(m, corner[2] - corner[0]);
    float uv_area = triangle_uv_area(is_triangle(quad), side);
    CellPoint point;
    point.triangle = make_triangle_point(transform_point(m, local), edge_b, edge_c,
                                         (instances[instance].levels & kMirrored) != 0u ? -1.0 : 1.0, uv_area);
    point.position_error = bound_error(instance, corner[0], corner[1], corner[2], point.triangle.position);
    point.triangle.position =
        leave_edges(point.triangle.position, point.position_error, weights, edge_b, edge_c,
                    2.0 * point.triangle.area_per_uv * uv_area);
    return point;
}

CellPoint evaluate_hit(const HitData hit) {
    CellPlace place = {hit.u, hit.v, cell_column(hit.cell), cell_row(hit.cell), cell_is_upper(hit.cell) != 0u};
    return evaluate_cell(hit.instance, hit.patch_index, hit.levels, place);
}

/// Point (u, v) of a patch as rays with this LOD bias see it.
CellPoint evaluate_point(const uint instance, const uint patch_index, const vec2 uv, const uint lod_bias) {
    uint packed_levels = lower_packed_levels(find_levels(instances[instance], patch_index), lod_bias);
    uint side = 1u << packed_patch_level(packed_levels);
    bool is_polygon = is_triangle(load_quad(surfaces[instances[instance].surface], patch_index));
    CellPlace place = locate_cell(is_polygon, side, uv.x, uv.y);
    return evaluate_cell(instance, patch_index, packed_levels, place);
}

#endif
