// What is said of a tessellated scene beforehand is what a tessellated render then allocates.
#include <gtest/gtest.h>

#include "relief/inspect.h"
#include "relief/samples.h"

namespace relief {
namespace {

TEST(TessellationCost, is_what_the_pumpkin_really_takes) {
    const Scene pumpkin = make_sample_scene("pumpkin", Instancing::none);
    for (const int level : {2, 4}) {
        RenderSettings settings;
        settings.image.width = settings.image.height = 16;
        settings.image.spp = 1, settings.image.bounces = 0;
        settings.surface.level = level;
        const TessellationCost cost = estimate_tessellation(pumpkin, settings);
        settings.surface.mode = SurfaceMode::tessellated;
        const Statistics s = render(pumpkin, settings).statistics;
        EXPECT_EQ(cost.micro_quads, 800u << 2 * level);
        EXPECT_EQ(cost.geometry_bytes, s.geometry_bytes);
        EXPECT_NEAR(double(cost.structures_bytes), double(s.structures_bytes),
                    0.1 * double(s.structures_bytes));
        EXPECT_GT(cost.peak_bytes, s.geometry_bytes + s.structures_bytes);
    }
}

} // namespace
} // namespace relief
