// Where a ray begins for one object: measured from a point near the object, and, for a ray from far away,
// moved along itself to just before the object. See docs/decisions/local-origins.md.
#ifndef RELIEF_LOCAL_START_H
#define RELIEF_LOCAL_START_H
#include "formulas/exact.h"

#include "formulas/begin.h"

/// Sizes of an object that a ray begins away from it, beyond which it is moved: all of the object is smaller
/// than half a pixel of a picture 2160 pixels high.
const float kFarAway = 4096.0f;

struct LocalStart {
    Vec3 origin; ///< less that of the object's space
    float shift; ///< the ray's own t there
};

/// What a - b rounds off, exactly (Knuth 1969, The Art of Computer Programming, volume 2, 4.2.2).
FN Vec3 find_lost_by_subtraction(const Vec3 a, const Vec3 b, const Vec3 difference) {
    EXACT Vec3 b_there = a - difference;
    EXACT Vec3 a_there = difference + b_there;
    EXACT Vec3 of_a = a - a_there;
    EXACT Vec3 of_b = b_there - b;
    EXACT Vec3 lost = of_a + of_b;
    return lost;
}

/// origin + speed t with a single rounding, so that distant rays are not shifted: the rounding error of the
/// product is added afterwards.
FN float move_origin(const float origin, const float speed, const float t) {
    EXACT float product = speed * t;
    EXACT float sum = origin + product;
    if (!(abs(t) < 1e34f)) return sum;
    EXACT float result = sum + find_product_error(speed, t, product);
    return result;
}

FN float greatest_size(const Vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

/// Whether a ray that begins at `origin` is moved for an object within `reach` of `center`.
FN bool is_far_away(const Vec3 origin, const Vec3 center, const float reach) {
    return greatest_size(subtract_exact(origin, center)) > kFarAway * reach;
}

/// `space_origin`: what places are measured from; `center`, `reach`: a sphere about the object, world space.
/// All t of the ray within it are `shift` and something positive. The moved origin is off by its own
/// rounding, not by that of the way there.
FN LocalStart find_local_start(const Vec3 origin, const Vec3 direction, const Vec3 space_origin,
                               const Vec3 center, const float reach) {
    LocalStart start = {subtract_exact(origin, space_origin), 0.0f};
    if (!is_far_away(origin, center, reach)) return start;
    // Rounded alike by all kernels: they find the start of one ray again and again.
    float speed = greatest_size(direction);
    EXACT float way_x = direction.x / speed;
    EXACT float way_y = direction.y / speed;
    EXACT float way_z = direction.z / speed;
    Vec3 way = {way_x, way_y, way_z};
    Vec3 back = subtract_exact(origin, center);
    // Before the middle by so much that neither rounding nor the length of the direction matters.
    EXACT float before = 2.0f * reach + 4e-6f * greatest_size(back);
    EXACT float middle = -dot_exact(back, way) / dot_exact(way, way);
    EXACT float shift = (middle - before) / speed;
    Vec3 lost = find_lost_by_subtraction(origin, space_origin, start.origin);
    EXACT float x = move_origin(start.origin.x, direction.x, shift) + lost.x;
    EXACT float y = move_origin(start.origin.y, direction.y, shift) + lost.y;
    EXACT float z = move_origin(start.origin.z, direction.z, shift) + lost.z;
    Vec3 moved = {x, y, z};
    if (!(shift > 0.0f && is_finite(moved))) return start;
    start.origin = moved;
    start.shift = shift;
    return start;
}

/// What the place of an object and that of a point on it add to how far rounding may move the point. Where
/// rays are measured from the object they round once each, and so does the origin of a ray that starts there;
/// else a few times more on the way back into the object's space.
FN float share_of_place(const Vec3 space_origin) {
    return greatest_size(space_origin) > 0.0f ? 0.125f : 1.0f;
}

#include "formulas/end.h"
#endif
