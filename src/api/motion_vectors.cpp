#include "api/motion_vectors.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "cpu/shading/surface_points.h"
#include "prepare/camera_frame.h"

namespace relief {

namespace {

constexpr size_t kPixelsOfAWorker = 1024; ///< pixels that a worker takes at a time

Ray make_ray(const scalar::CameraFrame& camera, int x, int y) {
    const scalar::CameraRay seen = scalar::make_pinhole_ray(camera, {float(x) + 0.5f, float(y) + 0.5f});
    Ray ray;
    ray.origin = seen.origin, ray.direction = seen.direction;
    return ray;
}

/// Nothing of a patch that there is no longer.
std::optional<Vec3f> find_position(const PreparedScene& scene, uint32_t object, uint32_t patch,
                                   const Vec2f& uv) {
    if (object >= scene.instances.size()) return std::nullopt;
    const Surface& surface = scene.surfaces[scene.instances[object].surface];
    if (patch >= surface.patch_count()) return std::nullopt;
    const cpu::TraceHit place = cpu::locate_hit(scene, object, patch, uv, 0);
    const std::optional<PatchSamples> samples = cpu::unpack_patch(scene, place);
    return cpu::make_cell_point(scene, place, samples ? &*samples : nullptr).position;
}

} // namespace

MotionVectors::MotionVectors(const Engine& engine, const PreparedScene& scene, const Window& window,
                             size_t rays_of_a_call)
    : window_(window), camera_(make_camera_frame(scene)) {
    const int width = window.x1 - window.x0;
    const int rows = std::max(1, int(rays_of_a_call) / std::max(1, width));
    seen_.reserve(size_t(width) * size_t(window.y1 - window.y0));
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
    for (int y0 = window.y0; y0 < window.y1; y0 += rows) {
        rays.clear();
        for (int y = y0; y < std::min(window.y1, y0 + rows); ++y)
            for (int x = window.x0; x < window.x1; ++x) rays.push_back(make_ray(camera_, x, y));
        hits.assign(rays.size(), {});
        engine.closest_hits(rays, hits, kVisibleToAll);
        for (const RayHit& hit : hits) seen_.push_back({hit.object, hit.patch, hit.uv});
    }
}

/// Of what is far behind all: it moves as the camera turns.
Vec3f MotionVectors::find_direction(size_t pixel) const {
    const auto width = size_t(window_.x1 - window_.x0);
    return make_ray(camera_, window_.x0 + int(pixel % width), window_.y0 + int(pixel / width)).direction;
}

std::vector<Vec2f> MotionVectors::find_places(const PreparedScene& scene) const {
    const scalar::CameraFrame camera = make_camera_frame(scene);
    constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
    std::vector<Vec2f> places(seen_.size(), {kNowhere, kNowhere});
    parallel_for("find_places", places.size(), kPixelsOfAWorker, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const Place& seen = seen_[k];
            const std::optional<Vec3f> position =
                seen.object == kNoIndex ? camera.origin + find_direction(k)
                                        : find_position(scene, seen.object, seen.patch, seen.uv);
            if (!position) continue;
            const scalar::CameraProjection projected = scalar::project_point(camera, *position);
            if (projected.distance > 0) places[k] = {projected.x, projected.y};
        }
    });
    return places;
}

} // namespace relief
