// Rays that graze long and narrow triangles hit those ahead of them only, alone and in packets.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cpu/tracer.h"
#include "support/grazed_sliver.h"
#include "support/isas.h"

namespace relief::cpu {
namespace {

using test::GrazedSliver;

class GrazedSlivers : public testing::TestWithParam<bool> {
  protected:
    /// Calls check(tracer) for each instruction set.
    template <class Check> void visit_isas(const Check& check) const {
        RenderSettings settings;
        settings.surface.level = 0;
        const auto scene = prepare_scene(sliver_.make_scene(GetParam()), settings);
        for (const Isa isa : test::machine_isas()) {
            SCOPED_TRACE(int(isa));
            settings.device.isa = isa;
            check(Tracer(scene, settings));
        }
    }

    GrazedSliver sliver_;
};

TEST_P(GrazedSlivers, are_hit_where_they_are_by_rays_that_start_before_them) {
    const std::vector<TraceRay> rays = sliver_.make_rays(500, GrazedSliver::kAhead);
    visit_isas([&](const Tracer& tracer) {
        std::vector<TraceHit> together(rays.size()), alone(1);
        std::vector<uint8_t> occluded(rays.size());
        tracer.closest_hits(rays, together);
        tracer.any_hits(rays, occluded);
        size_t missed = 0, misplaced = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            missed += !together[k].is_hit() || !occluded[k];
            misplaced += std::fabs(together[k].t - GrazedSliver::kAhead) > GrazedSliver::kTolerance;
            tracer.closest_hits(std::span(rays).subspan(k, 1), alone);
            ASSERT_EQ(together[k].t, alone[0].t) << "ray " << k;
        }
        EXPECT_EQ(missed, 0u);
        EXPECT_EQ(misplaced, 0u);
    });
}

TEST_P(GrazedSlivers, are_missed_by_rays_that_start_behind_them) {
    const std::vector<TraceRay> rays = sliver_.make_rays(500, -GrazedSliver::kAhead);
    visit_isas([&](const Tracer& tracer) {
        std::vector<TraceHit> together(rays.size()), alone(1);
        tracer.closest_hits(rays, together);
        size_t hit_count = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            tracer.closest_hits(std::span(rays).subspan(k, 1), alone);
            hit_count += together[k].is_hit() + alone[0].is_hit();
        }
        EXPECT_EQ(hit_count, 0u);
    });
}

/// A hit in doubt on a shared edge is not counted for both triangles, nor for none.
TEST(GrazedTriangles, are_hit_one_of_two_at_their_shared_edge) {
    const GrazedSliver sliver;
    const std::vector<TraceRay> rays = sliver.make_rays(500, GrazedSliver::kAhead);
    std::vector<TraceHit> hits[2];
    for (const bool is_upper : {false, true}) {
        hits[is_upper].resize(rays.size());
        Tracer(prepare_scene(sliver.make_triangle_scene(is_upper), {}), {})
            .closest_hits(rays, hits[is_upper]);
    }
    size_t both = 0, none = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        both += hits[0][k].is_hit() && hits[1][k].is_hit();
        none += !hits[0][k].is_hit() && !hits[1][k].is_hit();
    }
    EXPECT_EQ(both, 0u);
    EXPECT_EQ(none, 0u);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, GrazedSlivers, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                             return info.param ? "displaced" : "undisplaced";
                         });

} // namespace
} // namespace relief::cpu
