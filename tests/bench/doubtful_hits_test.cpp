#include "bench/doubtful_hits.h"

#include <gtest/gtest.h>

namespace relief::bench {
namespace {

TEST(DoubtfulHits, are_those_whose_box_the_ray_misses) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.face_sizes = {4};
    mesh.position_indices = {0, 1, 2, 3};
    const DoubtfulHits hits(mesh);
    const Ray down{.origin = {0.25f, 0.5f, 1}, .direction = {0, 0, -1}};
    const Ray beside{.origin = {-1e-4f, 0.5f, 1}, .direction = {0, 0, -1}};
    const Ray slanted{.origin = {-1, 0.5f, 2}, .direction = {0.5f - 1e-4f, 0, -1}};
    for (const uint32_t triangle : {0u, 1u}) {
        EXPECT_FALSE(hits.is_doubtful(down, {1, triangle}));
        EXPECT_TRUE(hits.is_doubtful(beside, {1, triangle}));
        EXPECT_TRUE(hits.is_doubtful(slanted, {2, triangle}));
        EXPECT_FALSE(hits.is_doubtful(down, {1 - 1e-7f, triangle}));
        EXPECT_TRUE(hits.is_doubtful(down, {0.9f, triangle}));
    }
    EXPECT_FALSE(hits.is_doubtful(beside, {}));
}

} // namespace
} // namespace relief::bench
