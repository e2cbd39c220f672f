// Rays that graze long and narrow triangles hit them on a device as on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cast_fixture.h"
#include "support/grazed_sliver.h"

namespace relief::vulkan::tests {
namespace {

class DeviceGrazedSlivers : public GpuTest, public testing::WithParamInterface<bool> {};

TEST_P(DeviceGrazedSlivers, are_hit_by_rays_that_start_near_them) {
    RenderSettings settings;
    settings.surface.level = 0;
    const test::GrazedSliver sliver;
    const auto scene = prepare_scene(sliver.make_scene(GetParam()), settings);
    const std::vector<cpu::TraceRay> rays = sliver.make_rays(60);
    const CastAnswers answers = cast_on_device(device(), *scene, settings, rays, {});
    EXPECT_EQ(std::ranges::count(answers.closest, scalar::kNone, &scalar::HitData::instance), 0);
    expect_same(answers, cast_on_cpu(scene, settings, rays), rays);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, DeviceGrazedSlivers, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                             return info.param ? "displaced" : "undisplaced";
                         });

} // namespace
} // namespace relief::vulkan::tests
