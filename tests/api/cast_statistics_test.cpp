// Statistics of casts by depth and kind, which add up to the totals, and of memory.
#include <gtest/gtest.h>

#include <cstddef>

#include "formulas/light_source.h"
#include "relief/render.h"
#include "relief/samples.h"
#include "support/bodies.h"

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

TEST(MemoryStatistics, include_tables_of_lights_and_the_distribution_of_the_environment) {
    RenderSettings settings;
    settings.image.width = settings.image.height = 8;
    settings.image.spp = 1, settings.image.bounces = 0;
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(1),
        test::make_displacement(test::make_random_map(8, 8, 0, 1), DisplacementSpace::object));
    const Statistics dark = render(scene, settings).statistics;
    constexpr size_t kLights = 100;
    for (size_t k = 0; k < kLights; ++k)
        scene.lights.push_back({.type = LightType::point, .position = {2, float(k), 3}});
    scene.environment.emplace().texture = test::make_random_map(64, 32, 0.5f, 2);
    const Statistics lit = render(scene, settings).statistics;
    EXPECT_GE(lit.structures_bytes, dark.structures_bytes + kLights * sizeof(scalar::LightSourceData));
    EXPECT_GE(lit.displacement_bytes, dark.displacement_bytes + 64 * 32 * sizeof(float));
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
