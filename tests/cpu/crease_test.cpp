// Rays that start beside a sharp crease, within a closed body: all of them meet it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "cpu/tracer.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

/// A prism along z whose walls meet at the origin's edge, 20 degrees apart.
Scene make_wedge() {
    const float half = std::tan(float(M_PI) / 18);
    Mesh mesh;
    mesh.positions = {{0, 0, -1}, {1, half, -1}, {1, -half, -1}, {0, 0, 1}, {1, half, 1}, {1, -half, 1}};
    mesh.face_sizes = {4, 4, 4, 3, 3};
    mesh.position_indices = {0, 3, 4, 1, 0, 2, 5, 3, 1, 4, 5, 2, 0, 1, 2, 3, 5, 4};
    Scene scene;
    scene.meshes = {mesh};
    scene.objects.emplace_back();
    return scene;
}

TEST(Crease, keeps_rays_that_start_beside_it) {
    const RenderSettings settings;
    const cpu::Tracer tracer(prepare_scene(make_wedge(), settings), settings);
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> along(-0.8f, 0.8f), aside(-2e-6f, 2e-6f);
    std::normal_distribution<float> normal;
    std::vector<cpu::TraceRay> rays(20000);
    for (cpu::TraceRay& ray : rays) {
        ray.origin = {0.8f, 0, along(generator)};
        ray.direction = normalize(Vec3f{0, aside(generator), along(generator)} - ray.origin);
    }
    std::vector<cpu::TraceHit> hits(rays.size());
    tracer.closest_hits(rays, hits);
    std::vector<cpu::TraceRay> next;
    for (size_t k = 0; k < hits.size(); ++k) {
        ASSERT_TRUE(hits[k].is_hit()) << k;
        const cpu::SurfacePoint point = tracer.make_surface_point(hits[k]);
        Vec3f direction = normalize(Vec3f{normal(generator), normal(generator), normal(generator)});
        const bool goes_back =
            dot(point.geometric_normal, direction) * dot(point.geometric_normal, rays[k].direction) < 0;
        if (!goes_back) direction = direction * -1.0f;
        next.push_back({.origin = tracer.offset_origin(point, direction), .direction = direction});
    }
    std::vector<cpu::TraceHit> ends(next.size());
    tracer.closest_hits(next, ends);
    size_t lost = 0;
    for (const cpu::TraceHit& end : ends) lost += end.is_hit() ? 0 : 1;
    EXPECT_EQ(lost, 0u);
}

} // namespace
} // namespace relief
