#include "api/motion_vectors.h"

#include <limits>
#include <optional>

#include "base/parallel.h"
#include "cpu/shading/surface_points.h"
#include "prepare/camera_frame.h"

namespace relief {

namespace {

constexpr size_t kPixelsOfAWorker = 1024; ///< pixels that a worker takes at a time

/// Nothing of a patch that there is no longer.
std::optional<Vec3f> find_position(const PreparedScene& scene, const RayHit& hit) {
    if (hit.object >= scene.instances.size()) return std::nullopt;
    const Surface& surface = scene.surfaces[scene.instances[hit.object].surface];
    if (hit.patch >= surface.patch_count()) return std::nullopt;
    const cpu::TraceHit place = cpu::locate_hit(scene, hit.object, hit.patch, hit.uv, 0);
    const std::optional<PatchSamples> samples = cpu::unpack_patch(scene, place);
    return cpu::make_cell_point(scene, place, samples ? &*samples : nullptr).position;
}

} // namespace

MotionVectors::MotionVectors(const Engine& engine, const PreparedScene& scene, const Window& window) {
    const scalar::CameraFrame camera = make_camera_frame(scene);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const scalar::CameraRay ray =
                scalar::make_pinhole_ray(camera, {float(x) + 0.5f, float(y) + 0.5f});
            rays_.push_back({});
            rays_.back().origin = ray.origin, rays_.back().direction = ray.direction;
        }
    hits_.resize(rays_.size());
    engine.closest_hits(rays_, hits_, kVisibleToAll);
}

std::vector<Vec2f> MotionVectors::find_places(const PreparedScene& scene) const {
    const scalar::CameraFrame camera = make_camera_frame(scene);
    constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
    std::vector<Vec2f> places(rays_.size(), {kNowhere, kNowhere});
    parallel_for("find_places", places.size(), kPixelsOfAWorker, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            // What is far behind all moves as the camera turns.
            std::optional<Vec3f> position = camera.origin + rays_[k].direction;
            if (hits_[k].object != kNoIndex) position = find_position(scene, hits_[k]);
            if (!position) continue;
            const scalar::CameraProjection projected = scalar::project_point(camera, *position);
            if (projected.distance > 0) places[k] = {projected.x, projected.y};
        }
    });
    return places;
}

} // namespace relief
