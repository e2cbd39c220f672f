// Casts on the device for tests: rays in, hits out, beside those of the CPU engine.
#pragma once

#include <numeric>
#include <random>
#include <vector>

#include "engine/cpu/tracer.h"
#include "engine/vulkan/tracer.h"
#include "gpu_fixture.h"
#include "math/affine.h"
#include "math/scalar.h"
#include "support/bodies.h"

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

/// Rays at the origin from all sides and from near it, at four biases, some short and some along an axis.
inline std::vector<cpu::TraceRay> make_rays(uint32_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<cpu::TraceRay> rays;
    for (uint32_t k = 0; k < count; ++k) {
        cpu::TraceRay ray;
        ray.origin =
            normalize(Vec3f{normal(random), normal(random), normal(random)}) * (k % 3 == 0 ? 0.3f : 4.0f);
        ray.direction = Vec3f{normal(random), normal(random), normal(random)} * 0.7f - ray.origin;
        if (k % 7 == 0) ray.direction.x = 0;
        if (k % 5 == 0) ray.t_max = 0.9f;
        ray.bias = k % 4;
        rays.push_back(ray);
    }
    return rays;
}

/// A displaced sphere, its mirrored instance, and a plain one.
inline Scene make_scene(DisplacementSpace space) {
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(2), test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), space));
    Object second = scene.objects[0];
    second.world_from_object = compose(make_translation({1.4f, 0.2f, 0}), make_scale({-0.5f, 0.7f, 0.6f}));
    Object plain = scene.objects[0];
    plain.displacement = kNoIndex;
    plain.world_from_object = compose(make_translation({-1.2f, 0.5f, 0.3f}), make_scale({0.6f, 0.6f, 0.6f}));
    scene.objects.push_back(second);
    scene.objects.push_back(plain);
    scene.camera.from = {2.5f, 0.4f, 0.6f};
    scene.camera.to = {0, 0, 0};
    return scene;
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
