// Pinhole and thin-lens camera (Kolb et al. 1995). Pixel (0, 0) is top left, y downwards.
#ifndef RELIEF_CAMERA_H
#define RELIEF_CAMERA_H
#include "formulas/picture_plane.h"
#include "formulas/warp.h"

#include "formulas/begin.h"

struct CameraFrame {
    Vec3 origin;
    Vec3 right, up, forward; ///< orthonormal
    Vec3 corner;             ///< from origin to the picture's top left corner on the plane at distance 1
    Vec3 step_x, step_y;     ///< one pixel to the right, one down, on that plane
    Float aperture_radius;   ///< 0: pinhole
    Float focus_distance;    ///< along the view axis
};

struct CameraRay {
    Vec3 origin, direction; ///< direction of unit length
};

/// Position in pixels and distance along the view axis.
struct CameraProjection {
    Float x, y, distance;
};

/// `up` must not be parallel to the view axis but may be oblique; `fov` is vertical, radians.
FN CameraFrame make_camera_frame(const Vec3 from, const Vec3 to, const Vec3 up, const Float fov,
                                 const Vec2 size) {
    Vec3 forward = normalize(to - from);
    Vec3 right = normalize(cross(forward, up));
    Vec3 true_up = cross(right, forward);
    Float half_height = tan(Float(0.5f) * fov);
    Float half_width = half_height * size.x / size.y;
    Vec3 corner = forward - right * half_width + true_up * half_height;
    Vec3 step_x = right * (Float(2.0f) * half_width / size.x);
    Vec3 step_y = true_up * (Float(-2.0f) * half_height / size.y);
    CameraFrame result = {from, right, true_up, forward, corner, step_x, step_y, Float(0.0f), Float(1.0f)};
    return result;
}

/// Ray through the point `pixel` of the picture (pixel centres at .5) of a camera without an aperture.
FN CameraRay make_pinhole_ray(const CameraFrame camera, const Vec2 pixel) {
    CameraRay result = {camera.origin,
                        normalize(find_picture_point(camera.corner, camera.step_x, camera.step_y, pixel))};
    return result;
}

/// Ray through `pixel` of the picture (centres at .5); `lens` in [0, 1)^2 is the point of the lens.
FN CameraRay make_camera_ray(const CameraFrame camera, const Vec2 pixel, const Vec2 lens) {
    Vec3 toward = find_picture_point(camera.corner, camera.step_x, camera.step_y, pixel);
    Vec2 disk = square_to_disk(lens);
    Vec3 offset =
        camera.right * (disk.x * camera.aperture_radius) + camera.up * (disk.y * camera.aperture_radius);
    Vec3 direction = normalize(toward * camera.focus_distance - offset);
    CameraRay result = {camera.origin + offset, direction};
    return result;
}

/// Projection of a point through the pinhole; meaningless for a distance <= 0.
FN CameraProjection project_point(const CameraFrame camera, const Vec3 p) {
    Vec3 v = p - camera.origin;
    Float distance = dot(v, camera.forward);
    Vec3 on_plane = v * (Float(1.0f) / distance) - camera.corner;
    CameraProjection result = {dot(on_plane, camera.step_x) / dot(camera.step_x, camera.step_x),
                               dot(on_plane, camera.step_y) / dot(camera.step_y, camera.step_y), distance};
    return result;
}

#include "formulas/end.h"
#endif
