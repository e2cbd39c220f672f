// Camera rays of many pixels, sixteen at a time.
#pragma once

#include <cstddef>
#include <cstring>

#include "cpu/tracer.h"
#include "cpu/traversal/lane_arrays-inl.h"
#include "formulas/camera.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// A pinhole camera, for many pixels.
struct WideCamera {
    wide::Vec3 corner, step_x, step_y;

    RELIEF_INLINE explicit WideCamera(const scalar::CameraFrame& camera)
        : corner(wide::spread(camera.corner)),
          step_x(wide::spread(camera.step_x)),
          step_y(wide::spread(camera.step_y)) {}

    /// Directions of scalar::make_pinhole_ray for sixteen positions; the last one fills missing lanes.
    RELIEF_INLINE wide::Vec3 aim(const Vec2f* positions, size_t count) const {
        static_assert(sizeof(Vec2f) == 8);
        alignas(64) Vec2f padded[16];
        if (count < 16) {
            for (size_t lane = 0; lane < 16; ++lane) padded[lane] = positions[HWY_MIN(lane, count - 1)];
            positions = padded;
        }
        wide::Vec2 place;
        Lanes16::load_pairs(&positions->x, place.x, place.y);
        return wide::make_unit(wide::find_picture_point(corner, step_x, step_y, place));
    }
};

/// The rays of up to sixteen directions, into memory.
RELIEF_INLINE void store_rays(const Vec3f& origin, const wide::Vec3& direction, size_t count,
                              cpu::TraceRay* rays) {
    static_assert(offsetof(cpu::TraceRay, direction) == 16 && offsetof(cpu::TraceRay, lod_bias) == 32);
    cpu::TraceRay start;
    start.origin = origin;
    LaneQuads quads;
    quads.set(direction.x, direction.y, direction.z, Lanes16(start.t_max));
    for (size_t lane = 0; lane < count; ++lane) {
        char* const ray = reinterpret_cast<char*>(&rays[lane]);
        std::memcpy(ray, &start, 16);
        std::memcpy(ray + 16, quads.lane[lane], 16);
        rays[lane].lod_bias = 0;
    }
}

/// scalar::make_pinhole_ray for each position in the picture.
inline void aim_rays(const scalar::CameraFrame& camera, const Vec2f* positions, size_t count,
                     cpu::TraceRay* rays) {
    const WideCamera wide_camera(camera);
    for (size_t first = 0; first < count; first += 16) {
        const size_t size = HWY_MIN(size_t(16), count - first);
        store_rays(camera.origin, wide_camera.aim(positions + first, size), size, rays + first);
    }
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
