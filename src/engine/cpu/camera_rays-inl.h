// Camera rays of many pixels, sixteen at a time.
#if defined(RELIEF_CAMERA_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_CAMERA_RAYS_INL_H
#undef RELIEF_CAMERA_RAYS_INL_H
#else
#define RELIEF_CAMERA_RAYS_INL_H
#endif

#include <cstddef>
#include <cstring>

#include "engine/cpu/tracer.h"
#include "math/scalar.h"
#include "math/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// scalar::make_pinhole_ray for each position in the picture.
inline void aim_rays(const scalar::CameraFrame& camera, const Vec2f* positions, size_t count,
                     cpu::TraceRay* rays) {
    static_assert(offsetof(cpu::TraceRay, direction) == 16 && offsetof(cpu::TraceRay, bias) == 32);
    const auto spread = [](const Vec3f& v) { return wide::Vec3{Lanes16(v.x), Lanes16(v.y), Lanes16(v.z)}; };
    const wide::Vec3 corner = spread(camera.corner), step_x = spread(camera.step_x),
                     step_y = spread(camera.step_y);
    cpu::TraceRay start;
    start.origin = camera.origin;
    for (size_t first = 0; first < count; first += 16) {
        const size_t size = HWY_MIN(size_t(16), count - first);
        alignas(64) float x[16] = {}, y[16] = {};
        for (size_t lane = 0; lane < size; ++lane)
            x[lane] = positions[first + lane].x, y[lane] = positions[first + lane].y;
        const wide::Vec3 direction = wide::make_unit(
            wide::find_picture_point(corner, step_x, step_y, {Lanes16::load(x), Lanes16::load(y)}));
        LaneQuads quads;
        quads.set(direction.x, direction.y, direction.z, Lanes16(start.t_max));
        for (size_t lane = 0; lane < size; ++lane) {
            char* const ray = reinterpret_cast<char*>(&rays[first + lane]);
            std::memcpy(ray, &start, 16);
            std::memcpy(ray + 16, quads.lane[lane], 16);
            rays[first + lane].bias = 0;
        }
    }
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
