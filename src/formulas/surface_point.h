// From a position on a patch to the surface point used in shading, in any number of lanes.
#if !defined(RELIEF_SURFACE_POINT_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_SURFACE_POINT_H
#include "formulas/cross.h"
#endif
#include "formulas/begin.h"

/// Barycentric weights of corners 1 and 2 of a micro-triangle.
struct CornerWeights {
    Float b, c;
};

/// Point of a micro-triangle, world space.
struct TrianglePoint {
    Vec3 position;
    Vec3 normal;       ///< unit length, oriented by the winding; zero for a degenerate triangle
    Float area_per_uv; ///< world-space area per area in the patch's (u, v)
};

/// Lower: P = P00 + x-y of P10 + y of P11; upper: x of P11 + y-x of P01. `at`: (u, v) on the patch; `cell`:
/// (i, j); `side`: cells along the patch.
FN CornerWeights weigh_cell_corners(const Vec2 at, const Vec2 cell, const Bool is_upper, const Float side) {
    Float x = clamp(at.x * side - cell.x, Float(0.0f), Float(1.0f));
    Float y = clamp(at.y * side - cell.y, Float(0.0f), Float(1.0f));
    CornerWeights weights = {select(is_upper, x, max(x - y, Float(0.0f))),
                             select(is_upper, max(y - x, Float(0.0f)), y)};
    return weights;
}

FN Vec3 blend_corners(const Vec3 a, const Vec3 b, const Vec3 c, const CornerWeights weights) {
    return a * (Float(1.0f) - weights.b - weights.c) + b * weights.b + c * weights.c;
}

/// `edge_b`, `edge_c`: from corner 0 to 1 and 2, world space; `turn`: -1 for mirrored instances, else 1.
FN TrianglePoint make_triangle_point(const Vec3 position, const Vec3 edge_b, const Vec3 edge_c,
                                     const Float turn, const Float uv_area) {
    // Of a triangle that has vanished exactly zero: a remainder would have a normal.
    Vec3 area = cross_exact(edge_b, edge_c) * turn;
    TrianglePoint point = {position, make_unit(area), Float(0.5f) * length(area) / uv_area};
    return point;
}

FN Float largest_coordinate(const Vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }
FN Float sum_magnitudes(const Vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

/// Bound of a point's position error: each step errs by a few ulp of the largest term. `corner`: largest
/// coordinate of the corners in object space; `row`: largest sum_magnitudes of the linear part's rows;
/// `translation` and `position`: their largest coordinates; `share`: share_of_place.
FN Float bound_position_error(const Float corner, const Float row, const Float translation,
                              const Float position, const Float share) {
    const float units = 32.0f * 5.9604644775390625e-8f;
    return Float(units) * (row * corner + translation * share + position * share);
}

/// `position`, moved inwards by up to a sixteenth of its triangle where an edge lies within 10 errors. The
/// origins of its rays lie off the triangle: at a sharp crease, next to the edge, that would be behind the
/// neighbour. `edge_b`, `edge_c`: as for make_triangle_point; `double_area`: twice the triangle's.
FN Vec3 leave_edges(const Vec3 position, const Float position_error, const CornerWeights weights,
                    const Vec3 edge_b, const Vec3 edge_c, const Float double_area) {
    const Float most = Float(0.0625f), zero = Float(0.0f);
    Float margin = select(double_area > zero, Float(10.0f) * position_error / double_area, zero);
    Float to_a =
        max(min(margin * length(edge_c - edge_b), most) - (Float(1.0f) - weights.b - weights.c), zero);
    Float to_b = max(min(margin * length(edge_c), most) - weights.b, zero);
    Float to_c = max(min(margin * length(edge_b), most) - weights.c, zero);
    Float all = to_a + to_b + to_c;
    return position + edge_b * (to_b - weights.b * all) + edge_c * (to_c - weights.c * all);
}

/// uv in a displaced patch, or a quad cut from one; corners in order.
FN Vec2 blend_patch_uv(const Vec2 c0, const Vec2 c1, const Vec2 c2, const Vec2 c3, const Vec2 at) {
    return (c0 * (Float(1.0f) - at.x) + c1 * at.x) * (Float(1.0f) - at.y) +
           (c3 * (Float(1.0f) - at.x) + c2 * at.x) * at.y;
}

/// uv in any other polygon: linear on each of its two triangles, as their positions are.
FN Vec2 blend_polygon_uv(const Vec2 c0, const Vec2 c1, const Vec2 c2, const Vec2 c3, const Vec2 at) {
    Vec2 lower = c0 * (Float(1.0f) - at.x) + c1 * (at.x - at.y) + c2 * at.y;
    Vec2 upper = c0 * (Float(1.0f) - at.y) + c2 * at.x + c3 * (at.y - at.x);
    return select(at.y <= at.x, lower, upper);
}

/// World-space shading normal: `interpolated`, normalised and oriented to the side of `geometric_normal`.
FN Vec3 orient_shading_normal(const Vec3 interpolated, const Vec3 geometric_normal) {
    Vec3 normal = make_unit(interpolated);
    normal = select(dot(normal, normal) == Float(0.0f), geometric_normal, normal);
    return select(dot(normal, geometric_normal) < Float(0.0f), -normal, normal);
}

/// Origin of a ray spawned into `direction`: offset from the surface by the point's error bound, along the
/// geometric normal, to the side of the direction.
FN Vec3 offset_origin(const Vec3 position, const Vec3 normal, const Float position_error,
                      const Vec3 direction) {
    Float side = select(dot(direction, normal) < Float(0.0f), Float(-1.0f), Float(1.0f));
    return position + normal * (side * position_error);
}

#include "formulas/end.h"
#endif
