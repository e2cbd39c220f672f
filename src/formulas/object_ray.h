// One ray in an object's space: conservative test against boxes, watertight against triangles.
#ifndef RELIEF_OBJECT_RAY_H
#define RELIEF_OBJECT_RAY_H
#include "formulas/exact_edge.h"
#include "formulas/local_start.h"

#include "formulas/begin.h"

/// (1 + 2 gamma(3)) of Ize 2013 (Robust BVH Ray Traversal), with room for Vulkan's 2.5 ulp.
const float kBoxSlack = 1.0000015f;

/// Smaller components of a direction (2^-120) count as zero in box tests.
const float kLeastSpeed = 7.52316384526264005e-37f;

struct ObjectRay {
    Vec3 origin, direction;
    Vec3 reciprocal;
    Vec3 margin;                 ///< outward offset of the origin along axes with zero direction
    uint axis_x, axis_y, axis_z; ///< the two minor axes and the major one
    float shear_x, shear_y;      ///< along the minor axes
    float shear_z;               ///< 1 / direction along the major one
    float shift;                 ///< t of the ray itself where `origin` lies: all t below are its own
};

/// Interval in which a ray is inside a box; a miss has entry > exit * kBoxSlack.
struct BoxInterval {
    float entry, exit;
};

FN float reciprocal_of_speed(const float speed) {
    return 1.0f / (abs(speed) < kLeastSpeed ? kLeastSpeed : speed);
}
FN float margin_of_axis(const float speed, const float origin) {
    return abs(speed) < kLeastSpeed ? 1e-6f * (abs(origin) + 1e-24f) : 0.0f;
}

/// The direction is not normalised, so t is the same in every space.
FN ObjectRay make_object_ray(const Vec3 origin, const Vec3 direction) {
    ObjectRay ray;
    ray.origin = origin;
    ray.direction = direction;
    Vec3 reciprocal = {reciprocal_of_speed(direction.x), reciprocal_of_speed(direction.y),
                       reciprocal_of_speed(direction.z)};
    // For a zero direction component 1 / 0 would give 0 * infinity for an origin exactly on a box face. A
    // finite factor, and an origin offset outward by more than rounding, make such a ray touch the box and
    // miss its neighbours.
    Vec3 margin = {margin_of_axis(direction.x, origin.x), margin_of_axis(direction.y, origin.y),
                   margin_of_axis(direction.z, origin.z)};
    ray.reciprocal = reciprocal;
    ray.margin = margin;
    float ax = abs(direction.x);
    float ay = abs(direction.y);
    float az = abs(direction.z);
    ray.axis_z = ax > ay ? (ax > az ? 0u : 2u) : (ay > az ? 1u : 2u);
    ray.axis_x = ray.axis_z == 2u ? 0u : ray.axis_z + 1u;
    ray.axis_y = ray.axis_x == 2u ? 0u : ray.axis_x + 1u;
    EXACT float shear_z = 1.0f / select_axis(direction, ray.axis_z);
    EXACT float shear_x = select_axis(direction, ray.axis_x) * shear_z;
    EXACT float shear_y = select_axis(direction, ray.axis_y) * shear_z;
    ray.shear_x = shear_x;
    ray.shear_y = shear_y;
    ray.shear_z = shear_z;
    ray.shift = 0.0f;
    return ray;
}

/// Within [t_min, t_max].
FN BoxInterval cross_box(const ObjectRay ray, const Vec3 lower, const Vec3 upper, const float t_min,
                         const float t_max) {
    EXACT Vec3 to_lower = (lower - (ray.origin + ray.margin)) * ray.reciprocal;
    EXACT Vec3 to_upper = (upper - (ray.origin - ray.margin)) * ray.reciprocal;
    bool is_x_backward = ray.reciprocal.x < 0.0f;
    bool is_y_backward = ray.reciprocal.y < 0.0f;
    bool is_z_backward = ray.reciprocal.z < 0.0f;
    float near_x = is_x_backward ? to_upper.x : to_lower.x;
    float near_y = is_y_backward ? to_upper.y : to_lower.y;
    float near_z = is_z_backward ? to_upper.z : to_lower.z;
    float far_x = is_x_backward ? to_lower.x : to_upper.x;
    float far_y = is_y_backward ? to_lower.y : to_upper.y;
    float far_z = is_z_backward ? to_lower.z : to_upper.z;
    EXACT float entry = max(max(near_x, near_y), near_z) + ray.shift;
    EXACT float exit = min(min(far_x, far_y), far_z) + ray.shift;
    BoxInterval result = {max(entry, t_min), min(exit, t_max)};
    return result;
}

FN bool is_box_met(const BoxInterval interval) {
    EXACT float reach = interval.exit * kBoxSlack;
    return interval.entry <= reach;
}

/// A vertex relative to the ray: sheared x and y, z along the major axis (Woop et al. 2013).
FN Vec3 shear_vertex(const ObjectRay ray, const Vec3 p) {
    EXACT float z = select_axis(p, ray.axis_z) - select_axis(ray.origin, ray.axis_z);
    EXACT float x = (select_axis(p, ray.axis_x) - select_axis(ray.origin, ray.axis_x)) - ray.shear_x * z;
    EXACT float y = (select_axis(p, ray.axis_y) - select_axis(ray.origin, ray.axis_y)) - ray.shear_y * z;
    Vec3 result = {x, y, z};
    return result;
}

struct TriangleHit {
    float t; ///< infinity: a miss
    float weight_b, weight_c;
};

/// Edge functions opposite the corners a, b and c, their sum, and the sum of z weighted by them.
struct TriangleEdges {
    float u, v, w, sum, weighted_z;
};

FN TriangleEdges weigh_edges(const Vec3 a, const Vec3 b, const Vec3 c, const float u, const float v,
                             const float w) {
    EXACT float sum = u + v + w;
    EXACT float weighted_z = u * a.z + v * b.z + w * c.z;
    TriangleEdges edges = {u, v, w, sum, weighted_z};
    return edges;
}

FN bool is_on_one_side(const float u, const float v, const float w) {
    return min(min(u, v), w) >= 0.0f || max(max(u, v), w) <= 0.0f;
}

/// Whether the ray's line goes through the triangle, which has an area as the ray sees it.
FN bool is_triangle_met(const TriangleEdges edges) {
    return is_on_one_side(edges.u, edges.v, edges.w) && edges.sum != 0.0f;
}

/// Whether rounding may have put the hit on the wrong side of the ray's origin (formulas/exact_edge.h). Its
/// place is a mean of z: where no corner or all corners are behind the origin, its sign is right.
FN bool is_place_doubtful(const Vec3 a, const Vec3 b, const Vec3 c, const TriangleEdges edges) {
    if (is_on_one_side(a.z, b.z, c.z)) return false;
    EXACT float products = find_largest(a.x, b.x, c.x) * find_largest(a.y, b.y, c.y);
    EXACT float rounding = products * find_largest(a.z, b.z, c.z) * kEdgeRounding;
    return abs(edges.weighted_z) <= rounding;
}

/// `a`, `b`, `c`: sheared corners. The sign of an edge function is never wrong, but the function may be zero.
/// Zero counts as inside; in a hit that is in doubt, the edge functions decide that are nearly exact. A ray
/// through a shared edge hits one of its triangles in either case. Fused operations would break this.
FN TriangleHit intersect_sheared(const ObjectRay ray, const Vec3 a, const Vec3 b, const Vec3 c,
                                 const float t_min, const float t_max) {
    EXACT float u = c.x * b.y - c.y * b.x;
    EXACT float v = a.x * c.y - a.y * c.x;
    EXACT float w = b.x * a.y - b.y * a.x;
    TriangleHit result = {uintBitsToFloat(0x7f800000u), 0.0f, 0.0f};
    TriangleEdges edges = weigh_edges(a, b, c, u, v, w);
    if (!is_triangle_met(edges)) return result;
    if (is_place_doubtful(a, b, c, edges))
        edges = weigh_edges(a, b, c, find_exact_edge(c.x, c.y, b.x, b.y), find_exact_edge(a.x, a.y, c.x, c.y),
                            find_exact_edge(b.x, b.y, a.x, a.y));
    EXACT float t = edges.weighted_z / edges.sum * ray.shear_z + ray.shift;
    // Asked again here and not in the branch: behind a return within it devices keep more registers.
    if (!is_triangle_met(edges) || !(t > t_min && t <= t_max)) return result;
    result.t = t;
    result.weight_b = edges.v / edges.sum;
    result.weight_c = edges.w / edges.sum;
    return result;
}

#include "formulas/end.h"
#endif
