// Statistics of casts by depth and kind; they add up to the totals.
#include <gtest/gtest.h>

#include "relief/render.h"
#include "relief/samples.h"

namespace relief {
namespace {

constexpr int kBounces = 2;

RenderSettings make_cast_settings() {
    RenderSettings settings;
    settings.image.width = 96, settings.image.height = 64;
    settings.image.spp = 2, settings.image.bounces = kBounces;
    return settings;
}

/// Made once: its map takes longer than the renders.
const Scene& get_ear() {
    static const Scene scene = make_sample_scene("ear", Instancing::none);
    return scene;
}

TEST(CastStatistics, are_ordered_by_depth_and_add_up_to_the_whole) {
    const Statistics s = render(get_ear(), make_cast_settings()).statistics;
    CastStatistics sum;
    uint64_t shadow_rays = 0, bounce_rays = 0;
    int previous = -1;
    for (const CastStatistics& cast : s.casts) {
        EXPECT_GT(2 * cast.depth + int(cast.is_shadow), previous);
        previous = 2 * cast.depth + int(cast.is_shadow);
        EXPECT_LE(cast.depth, kBounces + 1);
        EXPECT_GT(cast.rays, 0u);
        EXPECT_EQ(cast.sort_s, 0);
        if (cast.is_shadow)
            shadow_rays += cast.rays;
        else if (cast.depth > 0)
            bounce_rays += cast.rays;
        sum.pairs += cast.pairs;
        sum.top_traversal_s += cast.top_traversal_s;
        sum.bottom_build_s += cast.bottom_build_s;
        sum.bottom_traversal_s += cast.bottom_traversal_s;
    }
    ASSERT_EQ(s.casts.size(), 2u * (kBounces + 1) + 1); // the last rays look for light alone
    EXPECT_EQ(s.casts[0].rays, s.camera_rays);
    EXPECT_EQ(shadow_rays, s.shadow_rays);
    EXPECT_EQ(bounce_rays, s.bounce_rays);
    EXPECT_EQ(sum.pairs, s.pairs_emitted);
    EXPECT_DOUBLE_EQ(sum.top_traversal_s, s.top_traversal_s);
    EXPECT_DOUBLE_EQ(sum.bottom_build_s, s.bottom_build_s);
    EXPECT_DOUBLE_EQ(sum.bottom_traversal_s, s.bottom_traversal_s);
}

TEST(CastStatistics, show_that_trees_are_built_again_for_every_cast_without_a_cache) {
    uint64_t previous = 0;
    for (const int bounces : {0, 1}) {
        RenderSettings settings = make_cast_settings();
        settings.image.bounces = bounces;
        const Statistics cached = render(get_ear(), settings).statistics;
        settings.surface.cache_bytes = 0;
        const Statistics s = render(get_ear(), settings).statistics;
        EXPECT_GT(cached.bottom_reused, 0u);
        EXPECT_EQ(s.bottom_reused, 0u);
        // Shadow rays need the trees that camera rays had, and bounces need theirs once more.
        EXPECT_GT(s.bottom_built, 2 * cached.bottom_built) << bounces;
        EXPECT_GT(s.bottom_built, previous + cached.bottom_built) << bounces;
        previous = s.bottom_built;
    }
}

} // namespace
} // namespace relief
