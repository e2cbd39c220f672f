// Casts on the device against the CPU engine, ray for ray: levels, biases, spaces, leaves, forms of the
// bottom level, with and without cache, cut into chunks, rounds and waves as small as they go.
#include <cmath>
#include <ostream>
#include <random>

#include "cast_fixture.h"
#include "math/affine.h"
#include "support/bodies.h"

namespace relief::vulkan::tests {

namespace {

struct Case {
    const char* name;
    DisplacementSpace space = DisplacementSpace::object;
    int level = 4;
    LeafKind leaf = LeafKind::exact;
    BottomForm bottom = BottomForm::split;
    size_t cache_bytes = size_t(64) << 20;
    uint32_t pair_capacity = 1u << 16;
    uint32_t slots = 4;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

std::vector<cpu::TraceRay> make_rays(uint32_t count, uint32_t seed) {
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
Scene make_scene(DisplacementSpace space) {
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

void expect_same(const CastAnswers& device, const CpuAnswers& cpu, const std::vector<cpu::TraceRay>& rays) {
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

class VulkanTracerTest : public GpuTest, public testing::WithParamInterface<Case> {};

TEST_P(VulkanTracerTest, gives_the_hits_of_the_cpu_engine) {
    const Case& c = GetParam();
    RenderSettings settings;
    settings.level = c.level;
    settings.height = 60;
    settings.leaf = c.leaf;
    settings.bottom = c.bottom;
    settings.bottom_cache_bytes = c.cache_bytes;
    const std::shared_ptr<const PreparedScene> scene = prepare_scene(make_scene(c.space), settings);
    const std::vector<cpu::TraceRay> rays = make_rays(1500, 7);
    TracerConfig config;
    config.pair_capacity = c.pair_capacity;
    config.slots = c.slots;
    expect_same(cast_on_device(device(), *scene, settings, rays, config), cast_on_cpu(scene, settings, rays),
                rays);
}

INSTANTIATE_TEST_SUITE_P(
    everything, VulkanTracerTest,
    testing::Values(
        Case{.name = "level_0", .level = 0}, Case{.name = "level_2", .level = 2},
        Case{.name = "level_3", .level = 3}, Case{.name = "level_5", .level = 5},
        Case{.name = "tiles", .level = 6}, Case{.name = "auto_level", .level = kAutoLevel},
        Case{.name = "tangent_space", .space = DisplacementSpace::tangent},
        Case{.name = "tangent_auto", .space = DisplacementSpace::tangent, .level = kAutoLevel},
        Case{.name = "box_leaves", .leaf = LeafKind::box},
        Case{.name = "box_auto", .level = kAutoLevel, .leaf = LeafKind::box},
        Case{.name = "fused", .bottom = BottomForm::fused},
        Case{.name = "fused_tiles_box", .level = 6, .leaf = LeafKind::box, .bottom = BottomForm::fused},
        Case{.name = "no_cache", .cache_bytes = 0},
        Case{.name = "fused_without_cache",
             .level = kAutoLevel,
             .bottom = BottomForm::fused,
             .cache_bytes = 0},
        Case{.name = "one_patch_a_round", .pair_capacity = 64, .slots = 1},
        Case{.name = "many_chunks", .level = 3, .pair_capacity = 512, .slots = 8},
        Case{.name = "many_waves", .level = 6, .cache_bytes = 1}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace relief::vulkan::tests
