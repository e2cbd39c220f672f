// From a place on a patch to the point of the surface that shading sees.
#ifndef RELIEF_SURFACE_POINT_H
#ifndef __cplusplus
#define RELIEF_SURFACE_POINT_H
#endif

/// Place on a patch of side * side cells. `is_upper`: on the second triangle of cell (i, j).
struct CellPlace {
    float u, v;
    uint i, j;
    bool is_upper;
};

/// Barycentric weights of corners 1 and 2 of a micro-triangle.
struct CornerWeights {
    float b, c;
};

/// Point of a micro-triangle, world space.
struct TrianglePoint {
    Vec3 position;
    Vec3 normal;       ///< unit length, side of the winding; zero for a triangle that has vanished
    float area_per_uv; ///< world area over its share of the patch's (u, v)
};

/// Cell that holds (u, v); on a triangle (u, v) is folded into v <= u.
FN CellPlace locate_cell(bool is_triangle, uint side, float u, float v) {
    bool is_folded = is_triangle && v > u;
    CellPlace place;
    place.u = select(is_folded, v, u);
    place.v = select(is_folded, u, v);
    float x = clamp(place.u, 0.0f, 1.0f) * float(side);
    float y = clamp(place.v, 0.0f, 1.0f) * float(side);
    uint column = uint(x);
    uint row = uint(y);
    place.i = select(column < side, column, side - 1u);
    place.j = select(row < side, row, side - 1u);
    place.is_upper = !is_triangle && y - float(place.j) > x - float(place.i);
    return place;
}

/// Lower: P = P00 + x-y of P10 + y of P11; upper: x of P11 + y-x of P01.
FN CornerWeights weigh_corners(CellPlace place, float side) {
    float x = clamp(place.u * side - float(place.i), 0.0f, 1.0f);
    float y = clamp(place.v * side - float(place.j), 0.0f, 1.0f);
    CornerWeights weights = {place.is_upper ? x : max(x - y, 0.0f), place.is_upper ? max(y - x, 0.0f) : y};
    return weights;
}

/// Share of the patch's (u, v) that one micro-triangle has.
FN float triangle_uv_area(bool is_triangle, float side) { return is_triangle ? 1.0f : 0.5f / (side * side); }

FN Vec3 blend_corners(Vec3 a, Vec3 b, Vec3 c, CornerWeights weights) {
    return a * (1.0f - weights.b - weights.c) + b * weights.b + c * weights.c;
}

/// `edge_b`, `edge_c`: from corner 0 to corners 1 and 2, world space; `turn`: -1 where the instance mirrors,
/// else 1.
FN TrianglePoint make_triangle_point(Vec3 position, Vec3 edge_b, Vec3 edge_c, float turn, float uv_area) {
    Vec3 area = cross(edge_b, edge_c) * turn;
    TrianglePoint point = {position, make_unit(area), 0.5f * length(area) / uv_area};
    return point;
}

FN float largest_coordinate(Vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }
FN float sum_magnitudes(Vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

/// A point is interpolated between corners and transformed, and the ray that leaves it is transformed back:
/// each step errs by a few units in the last place of the largest number that it adds up. `corner`: largest
/// coordinate of the corners in object space; `row`: largest sum_magnitudes of the linear part's rows;
/// `translation` and `position`: their largest coordinates.
FN float bound_position_error(float corner, float row, float translation, float position) {
    const float units = 32.0f * 5.9604644775390625e-8f;
    return units * (row * corner + translation + position);
}

/// uv in a displaced patch; corners in their order.
FN Vec2 blend_patch_uv(Vec2 c0, Vec2 c1, Vec2 c2, Vec2 c3, Vec2 at) {
    return (c0 * (1.0f - at.x) + c1 * at.x) * (1.0f - at.y) + (c3 * (1.0f - at.x) + c2 * at.x) * at.y;
}

/// uv in a plain polygon: linear on each of its two triangles, as their positions are.
FN Vec2 blend_polygon_uv(Vec2 c0, Vec2 c1, Vec2 c2, Vec2 c3, Vec2 at) {
    Vec2 lower = c0 * (1.0f - at.x) + c1 * (at.x - at.y) + c2 * at.y;
    Vec2 upper = c0 * (1.0f - at.y) + c2 * at.x + c3 * (at.y - at.x);
    return select(at.y <= at.x, lower, upper);
}

/// World-space shading normal from that of the surface, `interpolated`, made unit length and put on the side
/// of `geometric_normal`.
FN Vec3 orient_shading_normal(Vec3 interpolated, Vec3 geometric_normal) {
    Vec3 normal = make_unit(interpolated);
    if (dot(normal, normal) == 0.0f) normal = geometric_normal;
    return select(dot(normal, geometric_normal) < 0.0f, -normal, normal);
}

/// Origin for a ray that leaves a point into `direction`: moved off the surface by the point's error, along
/// the geometric normal, to the side that the direction is on.
FN Vec3 offset_origin(Vec3 position, Vec3 normal, float position_error, Vec3 direction) {
    float side = dot(direction, normal) < 0.0f ? -1.0f : 1.0f;
    return position + normal * (side * position_error);
}

#endif
