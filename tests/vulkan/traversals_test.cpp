// Every structure and traversal that a device can walk the scene trees by finds the hits of the CPU engine.
#include "cast_fixture.h"
#include "support/choices.h"

namespace relief::vulkan::tests {
namespace {

using test::Choice;

class DeviceTraversals : public GpuTest, public testing::WithParamInterface<Choice> {
  protected:
    static void expect_same_hits(const Scene& scene, RenderSettings settings, TracerConfig config = {}) {
        const auto prepared = prepare_scene(scene, settings);
        const std::vector<cpu::TraceRay> rays = make_rays(1500, 7);
        const CpuAnswers expected = cast_on_cpu(prepared, settings, rays);
        settings.experiment.structure = GetParam().structure,
        settings.experiment.traversal = GetParam().traversal;
        expect_same(cast_on_device(device(), *prepared, settings, rays, config), expected, rays);
    }
};

/// Tiles, coarser patches and polygons, in many instances and many rounds.
TEST_P(DeviceTraversals, find_the_hits_of_the_cpu_engine) {
    RenderSettings settings;
    settings.image.width = 2000, settings.image.height = 1000;
    settings.surface.pixel_error = 4;
    expect_same_hits(make_crowd(), settings, {.slots = 2, .pair_capacity = 2000});
}

/// Pairs of rays and patches: a box around each keeps most rays out, whatever leaf it is found in.
uint64_t count_pairs(const Device& device, const Choice& choice) {
    RenderSettings settings;
    settings.surface.level = 4;
    settings.experiment.structure = choice.structure, settings.experiment.traversal = choice.traversal;
    const auto prepared = prepare_scene(make_crowd(), settings);
    return cast_on_device(device, *prepared, settings, make_rays(1500, 5), {}).statistics.pairs_emitted;
}

TEST_P(DeviceTraversals, enter_few_more_patches_than_the_stack_does) {
    const uint64_t least = count_pairs(device(), {StructureKind::bvh, TraversalKind::stack});
    EXPECT_GT(least, 1500u);
    EXPECT_LT(double(count_pairs(device(), GetParam())), 1.2 * double(least));
}

TEST_P(DeviceTraversals, find_hits_in_trees_that_are_deeper_than_words_are_long) {
    const Scene scene = test::make_deep_polygons(2000);
    RenderSettings settings;
    const auto prepared = prepare_scene(scene, settings);
    const std::vector<cpu::TraceRay> rays = test::make_rays_at_polygons(scene.meshes[0], 500);
    const CpuAnswers expected = cast_on_cpu(prepared, settings, rays);
    settings.experiment.structure = GetParam().structure,
    settings.experiment.traversal = GetParam().traversal;
    expect_same(cast_on_device(device(), *prepared, settings, rays, {}), expected, rays);
}

INSTANTIATE_TEST_SUITE_P(All, DeviceTraversals, testing::ValuesIn(test::list_choices(EngineKind::vulkan)),
                         [](const auto& info) { return test::name_choice(info.param); });

} // namespace
} // namespace relief::vulkan::tests
