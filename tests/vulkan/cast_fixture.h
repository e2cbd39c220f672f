// Casts on the device for tests: rays in, hits out, beside those of the CPU engine.
#pragma once

#include <numeric>
#include <vector>

#include "engine/cpu/tracer.h"
#include "engine/vulkan/tracer.h"
#include "gpu_fixture.h"
#include "math/scalar.h"

namespace relief::vulkan::tests {

struct CastAnswers {
    std::vector<scalar::HitData> closest;
    std::vector<uint8_t> occluded;
    Statistics statistics;
};

/// Both kinds of cast over the same rays.
inline CastAnswers cast_on_device(const Device& device, const PreparedScene& scene,
                                  const RenderSettings& settings, const std::vector<cpu::TraceRay>& rays,
                                  TracerConfig config) {
    config.ray_capacity = std::max<uint32_t>(1, uint32_t(rays.size()));
    const DeviceScene device_scene(device, scene);
    Tracer tracer(device, scene, device_scene, settings, config);
    std::vector<scalar::RayData> data;
    for (const cpu::TraceRay& ray : rays)
        data.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max, ray.bias});
    std::vector<uint32_t> numbers(rays.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    Buffer list(device, {"ray list", rays.size() * sizeof(uint32_t), Purpose::ray_buffers});
    list.upload(numbers);
    tracer.rays().upload(data);
    CastAnswers answers;
    tracer.closest_hits(list, uint32_t(rays.size()));
    answers.closest = tracer.hits().download<scalar::HitData>(rays.size());
    tracer.any_hits(list, uint32_t(rays.size()));
    for (const scalar::HitData& hit : tracer.hits().download<scalar::HitData>(rays.size()))
        answers.occluded.push_back(hit.instance != scalar::kNone);
    tracer.add_statistics(answers.statistics);
    return answers;
}

/// The same by the CPU engine.
struct CpuAnswers {
    std::vector<cpu::TraceHit> closest;
    std::vector<uint8_t> occluded;
};

inline CpuAnswers cast_on_cpu(const std::shared_ptr<const PreparedScene>& scene,
                              const RenderSettings& settings, const std::vector<cpu::TraceRay>& rays) {
    CpuAnswers answers;
    answers.closest.resize(rays.size());
    answers.occluded.resize(rays.size());
    const cpu::Tracer tracer(scene, settings);
    tracer.closest_hits(rays, answers.closest);
    tracer.any_hits(rays, answers.occluded);
    return answers;
}

} // namespace relief::vulkan::tests
