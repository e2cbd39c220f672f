// Conservative screen rectangles of triangles, rounding included, also of those behind the camera.
#ifndef RELIEF_RASTER_H
#define RELIEF_RASTER_H
#include "formulas/begin.h"

/// Error bound for a few dozen rounded operations, relative to the largest term of each sum.
const float kRasterSlack = 4e-6f;

/// A pinhole in the space of an object. A point at v from the origin appears at pixel (dot(v, x), dot(v, y))
/// / dot(v, w), and w is its distance along the view axis.
struct ObjectCamera {
    Vec3 origin; ///< bit-identical to that of object-space rays
    Vec3 x, y, w;
    Vec3 position_error;  ///< of the three sums, per unit of the largest coordinate of v
    Vec3 direction_error; ///< and per unit of w, because rays are rounded too
};

/// Vectors of CameraFrame in object space; or bounds of their components, as sums of magnitudes.
struct CameraVectors {
    Vec3 corner, step_x, step_y;
};

FN Vec3 cross_magnitudes(const Vec3 a, const Vec3 b) {
    Vec3 result = {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
    return result;
}

/// `bounds`: of `vectors`; `reach`: of the vectors to all points of the picture on the plane at distance 1.
FN ObjectCamera make_object_camera(const Vec3 origin, const CameraVectors vectors, const CameraVectors bounds,
                                   const Vec3 reach) {
    Vec3 x = cross(vectors.step_y, vectors.corner);
    Vec3 y = cross(vectors.corner, vectors.step_x);
    Vec3 w = cross(vectors.step_x, vectors.step_y);
    Vec3 x_bound = cross_magnitudes(bounds.step_y, bounds.corner);
    Vec3 y_bound = cross_magnitudes(bounds.corner, bounds.step_x);
    Vec3 w_bound = cross_magnitudes(bounds.step_x, bounds.step_y);
    float volume = dot(vectors.corner, w);
    float scale = 1.0f / volume;
    Vec3 one = {1.0f, 1.0f, 1.0f};
    Vec3 position_error = {dot(one, x_bound), dot(one, y_bound), dot(one, w_bound)};
    Vec3 direction_error = {dot(reach, x_bound), dot(reach, y_bound), dot(reach, w_bound)};
    float slack = kRasterSlack * abs(scale);
    // So flat an object that rounding hides its points' side of the camera: all are unknown.
    if (!(abs(volume) > kRasterSlack * dot(bounds.corner, w_bound))) slack = uintBitsToFloat(0x7f800000u);
    ObjectCamera camera = {
        origin, x * scale, y * scale, w * scale, position_error * slack, direction_error * slack};
    return camera;
}

/// Pixel coordinates times distance, and distance; each off by at most its error.
struct SeenPoint {
    Vec3 at, error;
};

FN SeenPoint see_point(const ObjectCamera camera, const Vec3 p) {
    Vec3 v = p - camera.origin;
    float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
    Vec3 at = {dot(v, camera.x), dot(v, camera.y), dot(v, camera.w)};
    SeenPoint seen = {at, camera.position_error * size + camera.direction_error * abs(at.z)};
    return seen;
}

FN bool is_in_front(const SeenPoint p) {
    return is_finite(p.at) && is_finite(p.error) && p.at.z > 2.0f * p.error.z;
}
FN bool is_behind(const SeenPoint p) {
    return is_finite(p.at) && is_finite(p.error) && p.at.z < -2.0f * p.error.z;
}

/// Pixel coordinates, y downwards; empty where x0 > x1.
struct ScreenBox {
    float x0, y0, x1, y1;
};

FN ScreenBox make_whole_screen() {
    float all = uintBitsToFloat(0x7f800000u);
    ScreenBox box = {-all, -all, all, all};
    return box;
}
FN ScreenBox make_empty_box() {
    float all = uintBitsToFloat(0x7f800000u);
    ScreenBox box = {all, all, -all, -all};
    return box;
}

/// Interval quotient of value +- error by distance +- distance_error, the latter positive.
FN float least_quotient(const float value, const float error, const float distance,
                        const float distance_error) {
    float least = value - error;
    return least / (least < 0.0f ? distance - distance_error : distance + distance_error);
}
FN float greatest_quotient(const float value, const float error, const float distance,
                           const float distance_error) {
    return -least_quotient(-value, error, distance, distance_error);
}

/// Extends the rectangle by a point in front of the camera.
FN ScreenBox add_point(const ScreenBox box, const SeenPoint p) {
    ScreenBox result = {min(box.x0, least_quotient(p.at.x, p.error.x, p.at.z, p.error.z)),
                        min(box.y0, least_quotient(p.at.y, p.error.y, p.at.z, p.error.z)),
                        max(box.x1, greatest_quotient(p.at.x, p.error.x, p.at.z, p.error.z)),
                        max(box.y1, greatest_quotient(p.at.y, p.error.y, p.at.z, p.error.z))};
    return result;
}

/// Homogeneous coordinate of a point before or behind the camera: coordinate times distance, distance.
struct SeenCoordinate {
    float at, error;
    float distance, distance_error;
};

/// A coordinate where the segment from a point in front to one behind crosses the camera plane, up to a
/// positive factor: its sign tells on which side the segment leaves the picture. 0: unknown.
FN float find_way_out(const SeenCoordinate front, const SeenCoordinate behind) {
    float crossing = front.at * behind.distance + behind.at * front.distance;
    float error = front.error * behind.distance + behind.error * front.distance +
                  abs(front.at) * behind.distance_error + abs(behind.at) * front.distance_error +
                  kRasterSlack * (abs(front.at) * behind.distance + abs(behind.at) * front.distance);
    return abs(crossing) > 2.0f * error ? crossing : 0.0f;
}

/// Extends the rectangle by the visible part of a segment from before the camera to behind it.
FN ScreenBox add_way_out(const ScreenBox box, const SeenPoint front, const SeenPoint behind) {
    float all = uintBitsToFloat(0x7f800000u);
    SeenCoordinate front_x = {front.at.x, front.error.x, front.at.z, front.error.z};
    SeenCoordinate front_y = {front.at.y, front.error.y, front.at.z, front.error.z};
    SeenCoordinate behind_x = {behind.at.x, behind.error.x, -behind.at.z, behind.error.z};
    SeenCoordinate behind_y = {behind.at.y, behind.error.y, -behind.at.z, behind.error.z};
    float x = find_way_out(front_x, behind_x);
    float y = find_way_out(front_y, behind_y);
    ScreenBox result = {x > 0.0f ? box.x0 : -all, y > 0.0f ? box.y0 : -all, x < 0.0f ? box.x1 : all,
                        y < 0.0f ? box.y1 : all};
    return result;
}

/// Rectangle of all triangles between four points.
FN ScreenBox bound_on_screen(const ObjectCamera camera, const Vec3 a, const Vec3 b, const Vec3 c,
                             const Vec3 d) {
    SeenPoint p[4] = {see_point(camera, a), see_point(camera, b), see_point(camera, c), see_point(camera, d)};
    ScreenBox box = make_empty_box();
    for (uint i = 0u; i < 4u; ++i) {
        if (is_behind(p[i])) continue;
        if (!is_in_front(p[i])) return make_whole_screen();
        box = add_point(box, p[i]);
        for (uint j = 0u; j < 4u; ++j)
            if (is_behind(p[j])) box = add_way_out(box, p[i], p[j]);
    }
    return box;
}

#include "formulas/end.h"
#endif
