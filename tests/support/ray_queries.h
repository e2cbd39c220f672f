// Rays of other programs at a crowd whose objects are visible to different queries.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "relief/intersect.h"
#include "support/casts.h"

namespace relief::test {

inline std::vector<Ray> make_query_rays(uint32_t count) {
    std::vector<Ray> rays;
    for (const cpu::TraceRay& ray : make_rays(count, 9))
        rays.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max});
    // From one point and in one direction, so that they travel in packets and bundles.
    for (uint32_t k = 0; k < count; ++k) {
        const float x = float(k % 32) / 16 - 1, y = float(k / 32 % 32) / 16 - 1;
        if (k % 1024 < 512)
            rays.push_back({{0, 0, 5}, 0, {x * 0.4f, y * 0.4f, -1}});
        else
            rays.push_back({{x, y, 5}, 0, {0, 0, -1}});
    }
    return rays;
}

inline Scene make_masked_crowd() {
    Scene scene = make_crowd();
    for (size_t k = 0; k < scene.objects.size(); ++k) scene.objects[k].visibility_mask = 1u << (k % 3);
    scene.objects[4].visibility_mask = 0x80000003;
    return scene;
}

/// That a query with `mask` finds what is found where there are no other objects.
inline void expect_masked_hits(const IntersectorSettings& settings, uint32_t mask) {
    const Scene crowd = make_masked_crowd();
    Scene alone = crowd;
    std::vector<uint32_t> kept;
    alone.objects.clear();
    for (uint32_t k = 0; k < crowd.objects.size(); ++k) {
        if ((crowd.objects[k].visibility_mask & mask) == 0) continue;
        kept.push_back(k);
        alone.objects.push_back(crowd.objects[k]);
    }
    ASSERT_FALSE(kept.empty());
    ASSERT_LT(kept.size(), crowd.objects.size());
    const std::vector<Ray> rays = make_query_rays(1024);
    std::vector<RayHit> hits(rays.size()), expected(rays.size());
    std::vector<uint8_t> any(rays.size()), expected_any(rays.size());
    const Intersector masked(crowd, settings), reference(alone, settings);
    masked.closest_hits(rays, hits, {.visibility_mask = mask});
    masked.any_hits(rays, any, mask);
    reference.closest_hits(rays, expected);
    reference.any_hits(rays, expected_any);
    EXPECT_EQ(any, expected_any);
    size_t hit_count = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_EQ(hits[k].t, expected[k].t) << k;
        ASSERT_EQ(hits[k].patch, expected[k].patch) << k;
        const bool is_hit = expected[k].object != kNoIndex;
        ASSERT_EQ(hits[k].object, is_hit ? kept[expected[k].object] : kNoIndex) << k;
        hit_count += is_hit;
    }
    EXPECT_GT(hit_count, 100u);
}

} // namespace relief::test
