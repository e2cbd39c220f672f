// Every structure and traversal that a device can walk the upper trees by finds the hits of the CPU engine.
#include <algorithm>

#include "cast_fixture.h"

namespace relief::vulkan::tests {
namespace {

struct Choice {
    StructureKind structure;
    TraversalKind traversal;
};

std::vector<Choice> list_choices() {
    std::vector<Choice> choices;
    for (const StructureKind structure : {StructureKind::bvh, StructureKind::lbvh, StructureKind::kdtree})
        for (const TraversalKind traversal : available_traversals(EngineKind::vulkan, structure))
            choices.push_back({structure, traversal});
    return choices;
}

class DeviceTraversals : public GpuTest, public testing::WithParamInterface<Choice> {
  protected:
    static void expect_same_hits(const Scene& scene, RenderSettings settings, TracerConfig config = {}) {
        const auto prepared = prepare_scene(scene, settings);
        const std::vector<cpu::TraceRay> rays = make_rays(1500, 7);
        const CpuAnswers expected = cast_on_cpu(prepared, settings, rays);
        settings.structure = GetParam().structure, settings.traversal = GetParam().traversal;
        expect_same(cast_on_device(device(), *prepared, settings, rays, config), expected, rays);
    }
};

/// Tiles, coarser patches and polygons, in many instances and many rounds.
TEST_P(DeviceTraversals, find_the_hits_of_the_cpu_engine) {
    RenderSettings settings;
    settings.width = 2000, settings.height = 1000;
    settings.pixel_error = 4;
    expect_same_hits(make_crowd(), settings, {.slots = 2, .pair_capacity = 2000});
}

INSTANTIATE_TEST_SUITE_P(All, DeviceTraversals, testing::ValuesIn(list_choices()), [](const auto& info) {
    std::string name =
        std::string(structure_name(info.param.structure)) + "_" + traversal_name(info.param.traversal);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

} // namespace
} // namespace relief::vulkan::tests
