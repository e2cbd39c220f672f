// Casts on the device for tests: rays in, hits out, beside those of the CPU engine.
#pragma once

#include <numeric>
#include <vector>

#include "formulas/constants.h"
#include "gpu_fixture.h"
#include "lab/scene_walks.h"
#include "support/casts.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/tracer.h"

namespace relief::vulkan::tests {

using test::cast_on_cpu;
using test::CpuAnswers;
using test::make_crowd;
using test::make_rays;
using test::make_scene;

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
    config.may_see_coarser = std::ranges::any_of(rays, [](const auto& ray) { return ray.lod_bias > 0; });
    const std::optional<SceneWalk> walk = make_device_walk(scene, settings);
    const DeviceScene device_scene(device, scene, walk ? &*walk : nullptr);
    Tracer tracer(device, scene, device_scene, settings, config);
    std::vector<scalar::RayData> data;
    for (const cpu::TraceRay& ray : rays)
        data.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max, ray.lod_bias});
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

/// Both kinds of cast agree, ray for ray, and enough rays hit something.
inline void expect_same(const CastAnswers& device, const CpuAnswers& cpu,
                        const std::vector<cpu::TraceRay>& rays) {
    size_t hit_count = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        const cpu::TraceHit& expected = cpu.closest[k];
        const scalar::HitData& found = device.closest[k];
        EXPECT_EQ(device.occluded[k], cpu.occluded[k]) << "ray " << k;
        ASSERT_EQ(found.instance, expected.instance)
            << "ray " << k << " t " << found.t << " not " << expected.t;
        if (!expected.is_hit()) continue;
        ++hit_count;
        EXPECT_NEAR(found.t, expected.t, 1e-6f * expected.t) << "ray " << k;
        EXPECT_EQ(found.patch_index, expected.patch) << "ray " << k;
        EXPECT_NEAR(found.u, expected.u, 1e-4f) << "ray " << k;
        EXPECT_NEAR(found.v, expected.v, 1e-4f) << "ray " << k;
    }
    EXPECT_GT(hit_count, rays.size() / 3);
}

} // namespace relief::vulkan::tests
