// Rays that graze long and narrow triangles hit them on a device as on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cast_fixture.h"
#include "support/grazed_sliver.h"

namespace relief::vulkan::tests {
namespace {

class DeviceGrazedSlivers : public GpuTest, public testing::WithParamInterface<bool> {};

TEST_P(DeviceGrazedSlivers, are_hit_by_rays_that_start_before_them_only) {
    RenderSettings settings;
    settings.surface.level = 0;
    const test::GrazedSliver sliver;
    const auto scene = prepare_scene(sliver.make_scene(GetParam()), settings);
    std::vector<cpu::TraceRay> rays = sliver.make_rays(60, sliver.kAhead);
    const auto ahead_count = std::ptrdiff_t(rays.size());
    for (const cpu::TraceRay& ray : sliver.make_rays(60, -sliver.kAhead)) rays.push_back(ray);
    const CastAnswers answers = cast_on_device(device(), *scene, settings, rays, {});
    const auto is_missed = [](const scalar::HitData& hit) { return hit.instance == scalar::kNone; };
    const auto behind = answers.closest.begin() + ahead_count;
    EXPECT_TRUE(std::none_of(answers.closest.begin(), behind, is_missed));
    EXPECT_TRUE(std::all_of(behind, answers.closest.end(), is_missed));
    expect_same(answers, cast_on_cpu(scene, settings, rays), rays);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, DeviceGrazedSlivers, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                             return info.param ? "displaced" : "undisplaced";
                         });

} // namespace
} // namespace relief::vulkan::tests
