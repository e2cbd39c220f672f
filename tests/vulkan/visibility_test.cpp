// A device skips the objects hidden by a query's mask, with every scene traversal.
#include "gpu_fixture.h"
#include "support/choices.h"
#include "support/ray_queries.h"

namespace relief::vulkan::tests {
namespace {

class DeviceVisibility : public GpuTest, public testing::WithParamInterface<test::Choice> {};

TEST_P(DeviceVisibility, is_that_of_a_scene_without_the_other_objects) {
    IntersectorSettings settings;
    settings.surface.level = 3;
    settings.device.engine = EngineKind::vulkan, settings.device.index = get_test_device_index();
    settings.experiment.structure = GetParam().structure;
    settings.experiment.traversal = GetParam().traversal;
    test::expect_masked_hits(settings, 2);
}

INSTANTIATE_TEST_SUITE_P(Traversals, DeviceVisibility,
                         testing::ValuesIn(test::list_choices(EngineKind::vulkan)),
                         [](const auto& info) { return test::name_choice(info.param); });

} // namespace
} // namespace relief::vulkan::tests
