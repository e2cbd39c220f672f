// The public batch call, used as another program would.
#include "relief/intersect.h"

#include <gtest/gtest.h>

#include "relief/error.h"
#include "support/bodies.h"

namespace relief {

namespace {

Scene make_query_scene() {
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(3),
        test::make_displacement(test::make_random_map(64, 64, 0.1f, 3), DisplacementSpace::tangent));
    scene.camera.from = {4, 0, 0};
    return scene;
}

TEST(Intersector, answers_closest_and_any_for_rays_of_any_length) {
    const Intersector intersector(make_query_scene(), {});
    std::vector<Ray> rays;
    for (int k = 0; k < 3000; ++k) {
        Ray ray;
        ray.origin = {4, float(k % 50) * 0.06f - 1.5f, float(k / 50) * 0.05f - 1.5f};
        ray.direction = {k % 3 == 0 ? -1e-20f : k % 3 == 1 ? -1.0f : -1000.0f, 0, 0};
        rays.push_back(ray);
    }
    std::vector<RayHit> hits(rays.size());
    std::vector<uint8_t> any(rays.size());
    intersector.closest_hits(rays, hits);
    intersector.any_hits(rays, any);
    size_t hit_count = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_EQ(any[k] != 0, hits[k].object == 0) << k;
        const float r = std::hypot(rays[k].origin.y, rays[k].origin.z);
        if (r < 0.7f) EXPECT_TRUE(any[k]) << k;
        if (r > 1.3f) EXPECT_FALSE(any[k]) << k;
        if (!any[k]) continue;
        ++hit_count;
        const float x = 4 + rays[k].direction.x * hits[k].t;
        EXPECT_GT(x, -0.5f) << k;
        EXPECT_LT(x, 1.3f) << k;
        EXPECT_NEAR(hits[k].normal.x * hits[k].normal.x + hits[k].normal.y * hits[k].normal.y +
                        hits[k].normal.z * hits[k].normal.z,
                    1, 1e-4f);
        EXPECT_LT(hits[k].patch, 54u);
    }
    EXPECT_GT(hit_count, 500u);
}

/// A quad at the corners of which sums of barycentric weights round up as often as down.
TEST(Intersector, gives_positions_within_the_patch) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-1.1f, -0.9f, 0.3f}, {1.3f, -1.2f, -0.2f}, {0.9f, 1.4f, 0.1f}, {-1.2f, 0.8f, -0.4f}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    mesh.face_sizes = {4};
    IntersectorSettings settings;
    settings.surface.level = 0;
    const Intersector intersector(
        test::make_body_scene(
            mesh, test::make_displacement(test::make_random_map(4, 4, 0, 1), DisplacementSpace::object)),
        settings);
    uint32_t state = 1;
    const auto draw = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f; };
    std::vector<Ray> rays(200000);
    for (size_t k = 0; k < rays.size(); ++k) { // at points of the edges u = 1 and v = 1
        const float part = draw();
        const Vec3f& end = mesh.positions[k % 2 ? 1 : 3];
        const Vec3f target = end + (mesh.positions[2] - end) * part;
        rays[k].origin = {4 * draw() - 2, 4 * draw() - 2, 5};
        rays[k].direction = target - rays[k].origin;
    }
    std::vector<RayHit> hits(rays.size());
    intersector.closest_hits(rays, hits);
    size_t at_end = 0;
    for (const RayHit& hit : hits) {
        if (hit.object == kNoIndex) continue;
        ASSERT_TRUE(hit.uv.x >= 0 && hit.uv.x <= 1 && hit.uv.y >= 0 && hit.uv.y <= 1)
            << hit.uv.x - 1 << " " << hit.uv.y - 1;
        at_end += hit.uv.x == 1 || hit.uv.y == 1;
    }
    EXPECT_GT(at_end, 1000u);
}

TEST(Intersector, respects_the_interval_of_a_ray) {
    const Intersector intersector(make_query_scene(), {});
    Ray ray;
    ray.origin = {4, 0.1f, 0.2f};
    ray.direction = {-1, 0, 0};
    RayHit whole, behind;
    intersector.closest_hits({&ray, 1}, {&whole, 1});
    ASSERT_EQ(whole.object, 0u);
    ray.t_max = whole.t * 0.99f;
    uint8_t is_hit = 1;
    intersector.any_hits({&ray, 1}, {&is_hit, 1});
    EXPECT_EQ(is_hit, 0);
    ray.t_max = 100;
    ray.t_min = whole.t * 1.01f;
    intersector.closest_hits({&ray, 1}, {&behind, 1});
    EXPECT_GT(behind.t, whole.t * 1.01f);
}

TEST(Intersector, refuses_settings_out_of_range_and_unequal_spans) {
    IntersectorSettings settings;
    settings.surface.level = 40;
    EXPECT_THROW(Intersector(make_query_scene(), settings), Error);
    const Intersector intersector(make_query_scene(), {});
    const std::vector<Ray> rays(3);
    std::vector<RayHit> hits(2);
    EXPECT_THROW(intersector.closest_hits(rays, hits), Error);
}

} // namespace

} // namespace relief
