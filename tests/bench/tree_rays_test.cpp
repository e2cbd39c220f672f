#include "bench/tree_rays.h"

#include <cmath>

#include <gtest/gtest.h>

namespace relief::bench {
namespace {

/// A square of two triangles in the plane z = 0.
Mesh make_square() {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.face_sizes = {4};
    mesh.position_indices = {0, 1, 2, 3};
    return mesh;
}

RaySet look_at_square() { return make_primary_rays(Camera{}, 16, 9); }

TEST(TreeRays, primary_rays_go_through_the_middle_of_pixels) {
    const RaySet set = look_at_square();
    ASSERT_EQ(set.rays.size(), 16u * 9u);
    EXPECT_EQ(set.kind, HitKind::closest);
    EXPECT_LT(set.rays[0].direction.x, 0);
    EXPECT_GT(set.rays[0].direction.y, 0);
    for (const Ray& ray : set.rays) EXPECT_LT(ray.direction.z, -0.8f);
    EXPECT_NEAR(set.rays[4 * 16].direction.y, 0, 1e-6f); // the middle row of nine
}

TEST(TreeRays, secondary_rays_start_at_hits_and_leave_on_the_side_that_is_seen) {
    const RaySet primary = look_at_square();
    std::vector<TreeHit> hits(primary.rays.size());
    for (size_t k = 0; k < hits.size(); k += 2)
        hits[k] = {5 / -primary.rays[k].direction.z, uint32_t(k / 2 % 2)};
    const std::vector<RaySet> sets = make_secondary_rays(make_square(), primary, hits, {0, 0, 2});
    ASSERT_EQ(sets.size(), 3u);
    for (const RaySet& set : sets) {
        ASSERT_EQ(set.rays.size(), hits.size() / 2) << set.name;
        EXPECT_EQ(set.kind == HitKind::closest, set.name == "diffuse");
        for (size_t k = 0; k < set.rays.size(); ++k) {
            EXPECT_EQ(set.parents[k], 2 * k);
            EXPECT_NEAR(set.rays[k].origin.z, 0, 1e-4f);
            EXPECT_GT(set.rays[k].direction.z, 0) << set.name;
            EXPECT_GT(set.rays[k].t_min, 0);
            EXPECT_EQ(std::isinf(set.rays[k].t_max), set.name != "occlusion");
        }
    }
}

} // namespace
} // namespace relief::bench
