#include "vulkan/ray_batch.h"

#include <algorithm>
#include <numeric>

#include "engine/finite_ray.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan {

namespace {

RayHit make_ray_hit(const scalar::HitData& found, const scalar::SurfacePointData& point) {
    RayHit hit;
    if (found.instance == scalar::kNone) return hit;
    hit.t = found.t;
    hit.object = found.instance;
    hit.patch = found.patch_index;
    hit.uv = {std::min(found.u, 1.0f), std::min(found.v, 1.0f)};
    hit.normal = point.geometric_normal;
    return hit;
}

} // namespace

RayBatch::RayBatch(Tracer& tracer)
    : tracer_(tracer),
      capacity_(tracer.config().ray_capacity),
      geometric_normal_(tracer.device(), {.shader = "geometric_normal",
                                          .constants = tracer.device_scene().add_filter({kGroupSize})}),
      list_(tracer.device(), {.name = "ray list", .bytes = uint64_t(capacity_) * sizeof(uint32_t)}),
      points_(tracer.device(),
              {.name = "points of rays", .bytes = uint64_t(capacity_) * sizeof(scalar::SurfacePointData)}) {
    std::vector<uint32_t> all(capacity_);
    std::iota(all.begin(), all.end(), 0u);
    list_.upload(all);
}

void RayBatch::upload(std::span<const Ray> rays) {
    std::vector<scalar::RayData> data;
    data.reserve(rays.size());
    constexpr scalar::RayData kNoRay{{0, 0, 0}, 0, {0, 0, 1}, -1, 0};
    for (const Ray& ray : rays)
        data.push_back(can_hit(ray) ? scalar::RayData{ray.origin, ray.t_min, ray.direction, ray.t_max, 0}
                                    : kNoRay);
    tracer_.rays().upload(data);
}

void RayBatch::closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) {
    tracer_.set_visibility_mask(mask);
    tracer_.bindings().bind(scalar::kBindPoints, points_);
    for (size_t first = 0; first < rays.size(); first += capacity_) {
        const uint32_t count = uint32_t(std::min<size_t>(capacity_, rays.size() - first));
        upload(rays.subspan(first, count));
        tracer_.closest_hits(list_, count);
        Commands& commands = tracer_.commands();
        commands.begin_stage(Stage::shade);
        commands.dispatch(geometric_normal_, count, count);
        commands.run();
        const auto found = tracer_.hits().download<scalar::HitData>(count);
        const auto points = points_.download<scalar::SurfacePointData>(count);
        for (uint32_t k = 0; k < count; ++k) hits[first + k] = make_ray_hit(found[k], points[k]);
    }
}

void RayBatch::any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) {
    tracer_.set_visibility_mask(mask);
    for (size_t first = 0; first < rays.size(); first += capacity_) {
        const uint32_t count = uint32_t(std::min<size_t>(capacity_, rays.size() - first));
        upload(rays.subspan(first, count));
        tracer_.any_hits(list_, count);
        const auto found = tracer_.hits().download<scalar::HitData>(count);
        for (uint32_t k = 0; k < count; ++k) hits[first + k] = found[k].instance != scalar::kNone;
    }
}

} // namespace relief::vulkan
