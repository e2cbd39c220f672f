// Rays that graze long and narrow triangles hit them, alone and in packets.
#include <gtest/gtest.h>

#include <vector>

#include "cpu/tracer.h"
#include "support/grazed_sliver.h"
#include "support/isas.h"

namespace relief::cpu {
namespace {

class GrazedSlivers : public testing::TestWithParam<bool> {};

TEST_P(GrazedSlivers, are_hit_by_rays_that_start_near_them) {
    RenderSettings settings;
    settings.surface.level = 0;
    const test::GrazedSliver sliver;
    const auto scene = prepare_scene(sliver.make_scene(GetParam()), settings);
    const std::vector<TraceRay> rays = sliver.make_rays(500);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const Tracer tracer(scene, settings);
        std::vector<TraceHit> together(rays.size()), alone(1);
        tracer.closest_hits(rays, together);
        size_t missed = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            missed += !together[k].is_hit();
            tracer.closest_hits(std::span(rays).subspan(k, 1), alone);
            ASSERT_EQ(together[k].t, alone[0].t) << int(isa) << ", ray " << k;
        }
        EXPECT_EQ(missed, 0u) << int(isa);
    }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, GrazedSlivers, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                             return info.param ? "displaced" : "undisplaced";
                         });

} // namespace
} // namespace relief::cpu
